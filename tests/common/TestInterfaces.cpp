#include "common/interface/InterfaceRegistry.h"
#include "common/interface/LocalAddress.h"
#include "common/interface/LocalInterface.h"
#include "common/interface/LocalServerInterface.h"
#include "common/interface/SocketTable.h"
#include "common/interface/TcpInterface.h"
#include "common/interface/TcpServerInterface.h"
#include "common/interface/UdpInterface.h"
#include "tests/support/FaultyInterface.h"
#include "tests/support/LoopbackInterface.h"

#include <sched.h>

using namespace hermes;

class TestInterfaces : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void parsesUrls_data() {
        const Rows<QString, QString, QString> row("text", "parsed", "protocol"); // parsed: "" means refused
        row("full", "tcp://127.0.0.1:7410?protocol=cbor", "tcp://127.0.0.1:7410", "cbor");
        row("bare", "robot:7410", "tcp://robot:7410", "json");
        row("IPv6", "[::1]:7410", "tcp://[::1]:7410", "json");
        row("device", "serial:///dev/ttyS1?baud=9600", "serial:///dev/ttyS1", "json");
        row("port too large", "tcp://1.2.3.4:99999", "", "");
        row("port alone", "7490", "", "");
        row("port alone, in a URL", "tcp://7490?protocol=json", "", "");
        row("space", "tcp://a b:1", "", "");
    }

    void parsesUrls() {
        FETCH(QString, text, QString, parsed);
        const auto url = InterfaceUrl::parse(text);
        QCOMPARE(url.ok(), !parsed.isEmpty());
        if (!url) {
            QVERIFY(url.error().message.contains(text));
            return;
        }
        QCOMPARE(url->toString(), parsed);
        QTEST(url->protocol(), "protocol");
    }

    void knowsWhatIsLocal_data() {
        const Rows<QString, bool> row("text", "local");
        row("loopback", "tcp://127.0.0.1:1", true);
        row("other loopback", "tcp://127.0.0.9:1", true);
        row("IPv6 loopback", "tcp://[::1]:1", true);
        row("localhost", "tcp://localhost:1", true);
        row("any", "tcp://0.0.0.0:1", false);
        row("any IPv6", "tcp://[::]:1", false);
        row("address", "udp://192.168.1.5:1", false);
        row("nothing", "tcp://:1", false);
    }

    void knowsWhatIsLocal() {
        QFETCH(QString, text);
        QTEST(!isOpenToNetwork(*InterfaceUrl::parse(text)), "local");
    }

    void tcpCarriesBothWays() {
        TcpServerInterface server(*InterfaceUrl::parse("127.0.0.1:0"), nullptr);
        Interface *peer = nullptr;
        connect(&server, &Listener::accepted, [&peer](Interface *accepted) { peer = accepted; });
        QVERIFY(server.listen());
        TcpInterface client(*InterfaceUrl::parse(server.address()), nullptr);
        client.open();
        QTRY_VERIFY(peer && client.isOpen());
        QByteArray atServer;
        QByteArray atClient;
        connect(peer, &Interface::received, [&](const QByteArray &bytes) { atServer += bytes; });
        connect(&client, &Interface::received, [&](const QByteArray &bytes) { atClient += bytes; });
        const QByteArray much(3 << 20, 'x'); // more than one read
        QVERIFY(client.write(much));
        QVERIFY(peer->write("back"));
        QTRY_COMPARE(atServer.size(), much.size());
        QTRY_COMPARE(atClient, QByteArray("back"));
        QCOMPARE(peer->counters().bytesIn, quint64(much.size()));
        QSignalSpy closed(&client, &Interface::closed);
        peer->close();
        QTRY_COMPARE(closed.count(), 1);
    }

    void tcpReconnects() {
        auto server = std::make_unique<TcpServerInterface>(*InterfaceUrl::parse("127.0.0.1:0"), nullptr);
        QVERIFY(server->listen());
        const auto url = *InterfaceUrl::parse(server->address());
        TcpInterface client(url, nullptr);
        client.setReconnecting(true);
        client.open();
        QTRY_VERIFY(client.isOpen());
        server.reset();
        QTRY_VERIFY(!client.isOpen());
        server = std::make_unique<TcpServerInterface>(url, nullptr);
        QVERIFY(server->listen());
        QTRY_VERIFY(client.isOpen());
        QCOMPARE(client.counters().opened, quint64(2));
        client.close();
        QCOMPARE(client.state(), Interface::State::Closed);
    }

    void portInUseIsNamed() {
        TcpServerInterface first(*InterfaceUrl::parse("127.0.0.1:0"), nullptr);
        QVERIFY(first.listen());
        const auto url = *InterfaceUrl::parse(first.address());
        const auto result = TcpServerInterface(url, nullptr).listen();
        QVERIFY(!result);
        VERIFY_CONTAINS(result.error().message,
                        QString("port %1 of 127.0.0.1 is already in use").arg(url.port));
    }

    void closedInterfaceRefusesAndCounts() {
        TcpInterface client(*InterfaceUrl::parse("127.0.0.1:1"), nullptr);
        QVERIFY(!client.write("abc"));
        QCOMPARE(client.counters().refusedBytes, quint64(3));
        QSignalSpy closed(&client, &Interface::closed);
        client.open();
        QTRY_COMPARE(closed.count(), 1);
        QVERIFY(closed[0][0].toString().contains("127.0.0.1:1"));
        QCOMPARE(client.counters().errors, quint64(1));
    }

    void writeLimitRefusesWhole() {
        const auto [near, far] = LoopbackInterface::pair(this);
        near->open();
        far->open();
        near->setWriteLimit(10);
        QVERIFY(near->write("12345678"));
        QVERIFY(!near->write("123"));
        QTRY_COMPARE(near->bytesToWrite(), qint64(0));
        QVERIFY(near->write("123"));
        QCOMPARE(near->counters().refusedBytes, quint64(3));
    }

    void udpKeepsDatagramsWhole() {
        UdpInterface server(*InterfaceUrl::parse("udp://127.0.0.1:0"), nullptr);
        server.open();
        QVERIFY(server.isOpen());
        UdpInterface client(
            *InterfaceUrl::parse(QString("udp://127.0.0.1:0?peer=127.0.0.1:%1").arg(server.localPort())),
            nullptr);
        client.open();
        QSignalSpy received(&server, &Interface::received);
        QSignalSpy answered(&client, &Interface::received);
        QVERIFY(!server.write("to nobody yet"));
        QVERIFY(client.write("one"));
        QVERIFY(client.write(QByteArray(1206, 'v')));
        QTRY_COMPARE(received.count(), 2);
        QCOMPARE(received[0][0].toByteArray(), QByteArray("one"));
        QCOMPARE(received[1][0].toByteArray().size(), 1206);
        QVERIFY(server.write("back"));
        QTRY_COMPARE(answered.count(), 1);
        UdpInterface second(*InterfaceUrl::parse(server.name()), nullptr);
        QSignalSpy closed(&second, &Interface::closed);
        second.open();
        QCOMPARE(closed.count(), 1); // the port is in use
    }

    void udpKeepsToItsSender() {
        QUdpSocket one, two;
        QVERIFY(one.bind(QHostAddress("127.0.0.1"), 0) && two.bind(QHostAddress("127.0.0.2"), 0));
        const auto interface = [](const QString &from) {
            return std::make_unique<UdpInterface>(*InterfaceUrl::parse("udp://127.0.0.1:0?from=" + from),
                                                  nullptr);
        };
        const QString both = QString("%1:%2");
        const auto first = interface("first"), second = interface("127.0.0.2"),
                   third = interface(QString("127.0.0.2:%1").arg(two.localPort()));
        for (const auto &[reader, wanted] :
             {std::pair(first.get(), QByteArray("one")), {second.get(), "two"}, {third.get(), "two"}}) {
            QSignalSpy received(reader, &Interface::received);
            reader->open();
            QVERIFY(reader->isOpen());
            for (int i = 0; i < 3; ++i) {
                one.writeDatagram("one", QHostAddress("127.0.0.1"), reader->localPort());
                two.writeDatagram("two", QHostAddress("127.0.0.1"), reader->localPort());
            }
            QTRY_COMPARE(received.count() + int(reader->strangers().datagrams), 6);
            QCOMPARE(received.count(), 3);
            for (const auto &arguments : received)
                QCOMPARE(arguments[0].toByteArray(), wanted);
            const QUdpSocket &stranger = wanted == "one" ? two : one;
            QCOMPARE(reader->strangers().names,
                     QStringList{both.arg(stranger.localAddress().toString()).arg(stranger.localPort())});
        }
        // At one address: who takes another port each time is one sender, who comes back is one of two.
        const auto fourth = interface("first");
        QSignalSpy received(fourth.get(), &Interface::received);
        fourth->open();
        QUdpSocket other;
        for (int i = 0; i < 20; ++i)
            QUdpSocket().writeDatagram("new", QHostAddress("127.0.0.1"), fourth->localPort());
        QTRY_COMPARE(received.count(), 20);
        for (int i = 0; i < 10; ++i)
            for (QUdpSocket *sender : {&one, &other})
                sender->writeDatagram("x", QHostAddress("127.0.0.1"), fourth->localPort());
        QTRY_COMPARE(received.count() + int(fourth->strangers().datagrams), 40);
        QCOMPARE(int(fourth->strangers().datagrams), 8); // but those until it was seen
        const auto wrong = interface("somebody");
        QSignalSpy closed(wrong.get(), &Interface::closed);
        wrong->open();
        VERIFY_CONTAINS(closed[0][0].toString(), "somebody");
    }

    void localSocketsNameTheirPeer() {
        QTemporaryDir folder;
        const auto url = *InterfaceUrl::parse("local://" + folder.filePath("socket"));
        LocalServerInterface server(url, nullptr);
        QVERIFY(server.listen());
        struct stat status {};
        QCOMPARE(::stat(QFile::encodeName(url.path).constData(), &status), 0);
        QCOMPARE(status.st_mode & 0777u, 0600u);
        std::unique_ptr<Interface> peer;
        connect(&server, &Listener::accepted, this, [&peer](Interface *arrived) { peer.reset(arrived); });
        LocalInterface client(url, nullptr);
        client.open();
        QVERIFY(client.isOpen());
        QTRY_VERIFY(peer);
        VERIFY_CONTAINS(peer->name(), QString("process %1 of user %2").arg(::getpid()).arg(::getuid()));
        QSignalSpy received(peer.get(), &Interface::received), answered(&client, &Interface::received);
        QSignalSpy closed(&client, &Interface::closed);
        QVERIFY(client.write("to the server") && peer->write("and back"));
        QTRY_COMPARE(received.count(), 1);
        QTRY_COMPARE(answered.count(), 1);
        peer->close();
        QTRY_COMPARE(closed.count(), 1);
    }

    void localSocketsReplaceOnlyWhatIsDead() {
        QTemporaryDir folder;
        const auto at = [&folder](const QString &name) {
            return *InterfaceUrl::parse("local://" + folder.filePath(name));
        };
        const auto problem = [](const InterfaceUrl &url) {
            LocalServerInterface server(url, nullptr);
            const auto listening = server.listen();
            return listening ? QString() : listening.error().message;
        };
        LocalServerInterface first(at("socket"), nullptr);
        QVERIFY(first.listen());
        QVERIFY(problem(at("socket")).contains("another program listens there"));
        QVERIFY(QFile::exists(folder.filePath("socket")));
        first.close();
        QVERIFY(!QFile::exists(folder.filePath("socket")));
        // As of a program that was killed.
        const Result<LocalAddress> address = LocalAddress::of(folder.filePath("dead"));
        const int left = LocalAddress::makeSocket();
        QCOMPARE(::bind(left, address->get(), address->size()), 0);
        LocalAddress::closeSocket(left);
        QCOMPARE(problem(at("dead")), QString());
        QFile file(folder.filePath("file"));
        QVERIFY(file.open(QIODevice::WriteOnly));
        QVERIFY(problem(at("file")).contains("not a socket"));
        QVERIFY(file.exists());
        QVERIFY(QFile::link(folder.filePath("file"), folder.filePath("link")));
        QVERIFY(problem(at("link")).contains("not a socket"));
        QVERIFY(problem(at("missing/socket")).contains("No such file"));
        QVERIFY(problem(at(QString(120, 'x'))).contains("1 to 107 bytes"));
        QVERIFY(
            problem(*InterfaceUrl::parse("local://" + folder.filePath("s") + "?mode=999")).contains("mode"));
        LocalInterface nobody(at("nobody"), nullptr);
        QSignalSpy closed(&nobody, &Interface::closed);
        nobody.open();
        QCOMPARE(closed.count(), 1);
        QVERIFY(closed[0][0].toString().contains("No such file"));
    }

    void socketsHaveAnOwner_data() {
        const Rows<QString, QString> row("host", "table");
        row("IPv4", "127.0.0.1", "/proc/net/tcp");
        row("IPv6", "::1", "/proc/net/tcp6");
    }

    void socketsHaveAnOwner() {
        QFETCH(QString, host);
        const QHostAddress address(host);
        QFETCH(QString, table);
        QTcpServer server;
        if (!server.listen(address))
            QSKIP(qPrintable("no address " + host + ": " + server.errorString()));
        QTcpSocket client;
        client.connectToHost(address, server.serverPort());
        QVERIFY(client.waitForConnected() && server.waitForNewConnection(5000 * patience));
        const SocketEnd from{address, client.localPort()}, to{address, server.serverPort()};
        const std::optional<unsigned> mine(::geteuid());
        QVERIFY(ownerOfSocket(from, to) == mine);
        QVERIFY(!ownerOfSocket(from, {address, quint16(to.port ^ 1)}));
        const QByteArray text = contentOf(table);
        QVERIFY2(ownerInSocketTable(text, from, to) == mine, text.constData());
        QVERIFY(!ownerInSocketTable(text, from, {address, quint16(to.port ^ 1)}));
    }

    // As Linux writes it on a little-endian machine.
    void socketTablesTellOwners() {
        if (Q_BYTE_ORDER != Q_LITTLE_ENDIAN)
            QSKIP("the table of this test is that of a little-endian machine");
        const QByteArray table =
            "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
            "inode\n"
            "   0: 0100007F:A000 0100007F:1CF2 01 00000000:00000000 00:00000000 00000000  1000        0 777 "
            "1 0\n"
            "   1: 0100007F:A001 0100007F:1CF2 06 00000000:00000000 00:00000000 00000000     0        0 0 3 "
            "0\n"
            "   2: 0000000000000000FFFF00000100007F:A002 0000000000000000FFFF00000100007F:1CF2 01 "
            "00000000:00000000 00:00000000 00000000  1001        0 778 1 0\n"
            "   3: 0100007F:A003 0100007F:1CF2 01\n"
            "nonsense\n";
        const SocketEnd to{QHostAddress(QHostAddress::LocalHost), 0x1cf2};
        const auto ownerAt = [&](quint16 port) { return ownerInSocketTable(table, {to.address, port}, to); };
        QVERIFY(ownerAt(0xa000) == 1000U);
        QVERIFY(!ownerAt(0xa001)); // closed
        QVERIFY(ownerAt(0xa002) == 1001U);
        QVERIFY(!ownerAt(0xa003)); // cut off
        QVERIFY(!ownerAt(0xa004));
        QVERIFY(!ownerInSocketTable({}, {to.address, 0xa000}, to));
    }

    void loopbackIsAsynchronous() {
        const auto [near, far] = LoopbackInterface::pair(this);
        near->open();
        far->open();
        QSignalSpy received(far, &Interface::received);
        near->write("x");
        QCOMPARE(received.count(), 0);
        QTRY_COMPARE(received.count(), 1);
        QSignalSpy closed(far, &Interface::closed);
        near->close();
        QTRY_COMPARE(closed.count(), 1);
    }

    void faultsAreRepeatable() {
        const auto run = [this](unsigned int seed) {
            const auto [near, far] = LoopbackInterface::pair(this);
            FaultyInterface faulty(near, {0.3, 0.3, 0.3, 0, seed}, nullptr);
            faulty.open();
            far->open();
            QByteArray got;
            connect(far, &Interface::received, [&got](const QByteArray &bytes) { got += bytes + '|'; });
            for (int i = 0; i < 100; ++i)
                faulty.write("message " + QByteArray::number(i));
            faulty.write("end");
            QTest::qWait(0);
            auto limit = runningTimer();
            for (int size = -1; size != got.size() && limit.elapsed() < 5000;) {
                size = got.size();
                QTest::qWait(20);
            }
            return std::make_pair(got, faulty.faultCount());
        };
        const auto first = run(7);
        QVERIFY(first.second > 10);
        QVERIFY(first.first.size() > 100);
        QCOMPARE(run(7), first);
        QVERIFY(run(8) != first);
    }

    void faultyKeepsOrderWithDelays() {
        const auto [near, far] = LoopbackInterface::pair(this);
        FaultyInterface faulty(near, {0, 0, 0.5, 5, 3}, nullptr);
        faulty.open();
        far->open();
        QByteArray sent;
        QByteArray got;
        connect(far, &Interface::received, [&got](const QByteArray &bytes) { got += bytes; });
        for (int i = 0; i < 50; ++i) {
            const QByteArray piece = QByteArray::number(i) + ',';
            sent += piece;
            faulty.write(piece);
        }
        QTRY_COMPARE(got, sent);
    }

    void aPeerThatVanishedIsFound_data() { falseAndTrue("writes", "only read", "written to"); }

    /// The last one: this process goes to a network of its own, whose only cable is then pulled.
    void aPeerThatVanishedIsFound() {
        QFETCH(bool, writes);
        if (::unshare(CLONE_NEWNET) != 0)
            QSKIP("no network namespace (needs root rights)");
        const auto setLink = [](const char *state) {
            return QProcess::execute("ip", {"link", "set", "lo", state});
        };
        QCOMPARE(setLink("up"), 0);
        TcpServerInterface server(*InterfaceUrl::parse("tcp://127.0.0.1:0"), nullptr);
        QVERIFY(server.listen());
        std::unique_ptr<Interface> peer;
        connect(&server, &Listener::accepted, this, [&peer](Interface *arrived) { peer.reset(arrived); });
        TcpInterface client(*InterfaceUrl::parse(server.address()), nullptr);
        client.open();
        QTRY_VERIFY(client.isOpen() && peer);
        QVERIFY(client.write("here"));
        QTRY_COMPARE(peer->counters().bytesIn, quint64(4));
        QSignalSpy closed(&client, &Interface::closed), peerClosed(peer.get(), &Interface::closed);
        QCOMPARE(setLink("down"), 0);
        if (writes)
            QVERIFY(client.write("to nobody") && peer->write("to nobody"));
        QTRY_VERIFY_WITH_TIMEOUT(closed.count() == 1 && peerClosed.count() == 1, 60000); // hours without
    }
};
