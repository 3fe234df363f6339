// Whatever is written to a stream, in whatever sizes, comes in order and whole; meanwhile it lies there once.
#include "common/interface/InterfaceRegistry.h"
#include "common/interface/Listener.h"
#include "common/tls/Authority.h"

using namespace hermes;

class TestLargeWrites : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        const Authority authority(folder_.filePath("keys"));
        QVERIFY(authority.init("tester", 1, 1) && authority.issue({"robot", "daemon"}, 1));
    }

    void init() {
        FETCH(QString, listen, QString, connect);
        writer_.reset();
        reader_.reset();
        read_.clear();
        const auto with = [this](QString url) { return url.replace("FOLDER", folder_.path()); };
        listener_.reset(*makeListener(*InterfaceUrl::parse(with(listen)), nullptr));
        QVERIFY(listener_->listen());
        QObject::connect(listener_.get(), &Listener::accepted, this,
                         [this](Interface *peer) { writer_.reset(peer); });
        const QUrl actual(listener_->address());
        const QString scheme = actual.scheme();
        const QString address = scheme + "://127.0.0.1:" + QString::number(actual.port()) +
                                (scheme == "tls" ? "?keys=" + folder_.filePath("keys") : QString());
        reader_.reset(
            *makeInterface(*InterfaceUrl::parse(with(connect).replace("ADDRESS", address)), nullptr));
        QObject::connect(reader_.get(), &Interface::received, this,
                         [this](const QByteArray &bytes) { read_ += bytes; });
        reader_->open();
        QTRY_VERIFY(reader_->isOpen() && writer_ && writer_->isOpen());
    }

    void comeInOrder_data() { carriers(); }

    void comeInOrder() {
        constexpr qint64 most = 40 << 20;
        std::mt19937 random(7);
        const auto draw = [&random](int least, int greatest) {
            return std::uniform_int_distribution<>(least, greatest)(random);
        };
        writer_->setWriteLimit(most);
        QByteArray written;
        int drains = 0;
        QObject::connect(writer_.get(), &Interface::drained, this, [&] {
            if (++drains % 5 == 0)
                writer_->flush(); // as who answers a stop
        });
        while (written.size() < most / 2) {
            const int size = draw(0, 3) == 0 ? draw(1, 3 << 20) : draw(1, 300);
            QByteArray piece(size, Qt::Uninitialized);
            for (char &byte : piece)
                byte = char(random());
            QVERIFY(writer_->write(piece));
            written += piece;
            if (draw(0, 4) == 0)
                writer_->flush();
            if (draw(0, 4) == 0)
                reader_->setReceiving(draw(0, 1) == 1);
            if (draw(0, 2) == 0)
                QCoreApplication::processEvents();
            QVERIFY(writer_->bytesToWrite() <= written.size());
        }
        reader_->setReceiving(true);
        QTRY_COMPARE_WITH_TIMEOUT(read_.size(), written.size(), 30000);
        QVERIFY(read_ == written);
        QTRY_COMPARE(writer_->bytesToWrite(), 0);
    }

    void areNotCopied_data() { carriers(); }

    void areNotCopied() {
        const auto inUse = [] {
            const auto all = mallinfo2();
            return qint64(all.uordblks + all.hblkhd);
        };
        if (inUse() == 0)
            QSKIP("a sanitizer has a heap of its own");
        reader_->setReceiving(false);
        const std::vector<QByteArray> replies(30, QByteArray(500000, 'x'));
        const qint64 before = inUse();
        qint64 most = 0;
        for (const QByteArray &reply : replies)
            QVERIFY(writer_->write(reply));
        for (int i = 0; i < 20; ++i) {
            writer_->flush();
            QCoreApplication::processEvents();
            most = std::max(most, inUse() - before);
        }
        QVERIFY2(writer_->bytesToWrite() > 5 << 20, saying(writer_->bytesToWrite()));
        QVERIFY2(most < 1 << 20, saying(most));
    }

    void areForgottenAtTheEnd_data() { carriers(); }

    void areForgottenAtTheEnd() {
        reader_->setReceiving(false);
        QVERIFY(writer_->write(QByteArray(12 << 20, 'x')));
        QVERIFY(writer_->bytesToWrite() > 0);
        writer_->close();
        QCOMPARE(writer_->bytesToWrite(), 0);
        QVERIFY(!writer_->write("x"));
    }

private:
    static void carriers() {
        const Rows<QString, QString> row("listen", "connect");
        row("tcp", "tcp://127.0.0.1:0", "ADDRESS");
        row("tls", "tls://127.0.0.1:0?keys=FOLDER/keys/issued-for/robot", "ADDRESS");
        row("local", "local://FOLDER/socket", "local://FOLDER/socket");
    }

    QTemporaryDir folder_;
    std::unique_ptr<Listener> listener_;
    std::unique_ptr<Interface> writer_, reader_;
    QByteArray read_;
};
