#include "common/daemon/SignalWatcher.h"
#include "common/platform/Console.h"
#include "common/tls/Authority.h"
#include "common/tls/KeyBundle.h"
#include "common/tls/KeyFolder.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/PairingServer.h"

#include <QDir>
#include <QJsonArray>
#include <QSslCertificate>
#include <cstdio>

namespace hermes::ctl {
namespace {

constexpr std::chrono::minutes longestWait{2};

std::chrono::milliseconds howLong(const Arguments &arguments) {
    return arguments.timeoutIsGiven ? std::min<std::chrono::milliseconds>(arguments.timeout, longestWait)
                                    : longestWait;
}

QString joinCommand(const QString &address, quint16 port, const PairingCode &code) {
    return QString("hermesctl keys join %1 %2").arg(PairingAddress{address, port}.text(), code.text());
}

void tellHow(const PairingCode &code, quint16 port, const Arguments &arguments) {
    const QStringList addresses = ownAddresses();
    const double seconds = double(howLong(arguments).count()) / 1000;
    if (arguments.json)
        return printJson(QJsonObject{{"code", code.text()},
                                     {"addresses", QJsonArray::fromStringList(addresses)},
                                     {"port", port},
                                     {"seconds", seconds},
                                     {"command", joinCommand(addresses.first(), port, code)}});
    printLine(QString("The code for %1 is  %2  , valid for one computer and %3 s.\n"
                      "Waiting on port %4. On the other computer type:\n  %5")
                  .arg(arguments.words.first(), code.text())
                  .arg(seconds)
                  .arg(port)
                  .arg(joinCommand(addresses.first(), port, code)));
    if (addresses.size() > 1)
        printLine(QString("or with another address of this one: %1").arg(addresses.mid(1).join(", ")));
}

/// What is left of the time, on one line of a terminal.
class CountDown {
public:
    explicit CountDown(bool json)
        : isOn_(!json && isTerminal(StandardStream::Errors)) {}
    ~CountDown() { clear(); }
    CountDown(const CountDown &) = delete;
    CountDown &operator=(const CountDown &) = delete;

    void show(std::chrono::seconds left) const {
        if (isOn_)
            std::fprintf(stderr, "\r\033[Kwaiting, %d:%02d left", int(left.count() / 60),
                         int(left.count() % 60));
    }
    void clear() const {
        if (isOn_)
            std::fputs("\r\033[K", stderr);
    }

private:
    const bool isOn_;
};

Result<PairingServer::Joined> waitForOther(PairingServer &server, const Arguments &arguments) {
    const CountDown countDown(arguments.json);
    return server.wait(howLong(arguments),
                       {[&countDown](auto left) { countDown.show(left); },
                        [&countDown](const QString &address, int left) {
                            countDown.clear();
                            note(QString("a wrong code from %1; attempts left: %2").arg(address).arg(left));
                        }});
}

Result<void> handOver(PairingStream &stream, const KeyBundle &keys) {
    const QByteArray json = keys.toJson();
    if (json.size() > KeyBundle::maxJsonBytes)
        return Error(ErrorCode::OverLimit, "the list of revoked certificates is too long");
    const QDeadlineTimer deadline(longestTransfer);
    if (const auto sent = stream.send(json, deadline); !sent)
        return sent;
    const auto answer = stream.receive(pairingStored.size(), deadline);
    if (!answer)
        return answer.error();
    if (*answer != pairingStored)
        return Error(ErrorCode::InvalidRequest, "the other side answers with something else");
    return stream.send(pairingAccepted, deadline);
}

Error notTaken(const Authority &authority, const QString &name, const QString &folder, const Error &why) {
    const auto back = authority.takeBack(folder);
    const QString what = QString("the keys of %1 were not taken over (%2); ").arg(name, why.message);
    return {ErrorCode(why.code),
            what + (back ? "their certificate is revoked, and their folder removed: begin anew"
                         : QString("their certificate cannot be taken back: %1; hermesctl keys revoke %2")
                               .arg(back.error().message, name))};
}

void tellSuccess(const Arguments &arguments, const QString &address, const QString &serial) {
    const QString &name = arguments.words.first();
    print(
        arguments,
        QJsonObject{{"name", name}, {"role", arguments.role}, {"serial", serial}, {"address", address}},
        QString("%1 (%2) at %3 has its keys; serial number %4.").arg(name, arguments.role, address, serial));
}

/// From here on the code was proven.
Result<void> give(const Authority &authority, const PairingServer::Joined &joined,
                  const Arguments &arguments) {
    const SignalWatcher ignored(nullptr); // what is begun is ended in order, whoever asks for the end
    const QString &name = arguments.words.first();
    const auto folder = authority.issue({name, arguments.role}, arguments.days);
    if (!folder)
        return folder.error();
    const auto keys = KeyBundle::read(*folder);
    const auto given = keys ? handOver(*joined.stream, *keys) : keys.error();
    if (!given)
        return notTaken(authority, name, *folder, given.error());
    if (!QDir(*folder).removeRecursively()) // the only copy of the key is there now
        note(QString("%1 cannot be removed: delete it, the key in it is in use elsewhere").arg(*folder));
    tellSuccess(arguments, joined.address, toPeer(QSslCertificate(keys->certificate)).serial);
    return {};
}

} // namespace

Result<void> keysPair(const Arguments &arguments) {
    const Authority authority(KeyFolder::usual());
    if (const auto can = authority.canIssue(arguments.words.first()); !can)
        return can;
    const auto code = PairingCode::make();
    if (!code)
        return code.error();
    const auto secret = code->secret();
    if (!secret)
        return secret.error();
    const quint16 port = arguments.port > 0 ? quint16(arguments.port) : usualPairingPort;
    PairingServer server(*secret);
    if (const auto listening = server.listen(port); !listening)
        return listening;
    tellHow(*code, port, arguments);
    const auto joined = waitForOther(server, arguments);
    return joined ? give(authority, *joined, arguments) : Result<void>(joined.error());
}

} // namespace hermes::ctl
