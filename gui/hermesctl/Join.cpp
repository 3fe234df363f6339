#include "common/daemon/SignalWatcher.h"
#include "common/tls/FolderPlace.h"
#include "common/tls/KeyBundle.h"
#include "common/tls/KeyFolder.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/PairingStream.h"

#include <QDir>
#include <QSslCertificate>
#include <QTcpSocket>
#include <QTemporaryDir>

namespace hermes::ctl {
namespace {

/// A folder of keys that comes into being whole, or not at all: it is written beside its place, and put there
/// in the end. What was not kept is removed; what this one has not made is left alone.
class NewKeyFolder {
public:
    explicit NewKeyFolder(const QString &place)
        : place_(placeOf(place)) {}

    /// Error: there are keys already, or something else.
    Result<void> check() const {
        const QFileInfo info(place_);
        if (!info.exists() && !info.isSymLink())
            return {};
        if (!info.isDir())
            return failed("is no folder");
        if (QDir(place_).isEmpty(QDir::AllEntries | QDir::Hidden | QDir::System | QDir::NoDotAndDotDot))
            return {};
        const bool hasKeys = QFile::exists(QDir(place_).filePath(KeyFolder::keyFile()));
        return failed(hasKeys ? "there are keys already; they are not replaced"
                              : "the folder is not empty; nothing in it is replaced");
    }

    /// Error also when programs could not use them: KeyFolder::load().
    Result<void> stage(const KeyBundle &keys) {
        QDir().mkpath(QFileInfo(place_).path());
        // Only its owner may enter. Nobody knows its name before: there is no other one, nor a link, in its
        // place.
        staged_ = std::make_unique<QTemporaryDir>(place_ + "-XXXXXX");
        if (!staged_->isValid())
            return failed(staged_->errorString());
        if (const auto written = keys.write(staged_->path()); !written)
            return written;
        if (const auto usable = KeyFolder::load(staged_->path()); !usable)
            return usable.error();
        const auto revoked = KeyFolder::revoked(staged_->path());
        return revoked ? Result<void>() : revoked.error();
    }

    Result<void> keep() {
        if (!takePlace(staged_->path(), place_))
            return failed(qt_error_string() +
                          "; nothing was kept here: revoke the keys where they were made");
        staged_->setAutoRemove(false);
        return {};
    }

private:
    static QString placeOf(const QString &path) {
        const QFileInfo info(path); // a link stays one, and leads to the keys
        return QDir::cleanPath(info.exists() ? info.canonicalFilePath() : info.absoluteFilePath());
    }
    Error failed(const QString &why) const {
        return {ErrorCode::InputOutput, QString("%1: %2").arg(place_, why), QJsonObject{{"path", place_}}};
    }

    const QString place_;
    std::unique_ptr<QTemporaryDir> staged_;
};

using Stream = std::unique_ptr<PairingStream>;

Result<sockets::Socket> connectTo(const PairingAddress &address, std::chrono::milliseconds timeout) {
    QTcpSocket socket;
    socket.connectToHost(address.host, address.port);
    const auto own = socket.waitForConnected(int(timeout.count()))
                         ? sockets::duplicate(socket.socketDescriptor())
                         : sockets::none;
    if (own != sockets::none)
        return own;
    return Error(ErrorCode::Disconnected,
                 QString("cannot connect to port %1 of %2: %3; is hermesctl keys pair waiting there?")
                     .arg(address.port)
                     .arg(address.host, socket.errorString()));
}

Result<Stream> secureStreamTo(const PairingAddress &address, const PairingCode &code,
                              std::chrono::milliseconds timeout) {
    const auto secret = code.secret();
    if (!secret)
        return secret.error();
    const auto socket = connectTo(address, timeout);
    if (!socket)
        return socket.error();
    auto stream = std::make_unique<PairingStream>(PairingStream::Side::Client, *socket, *secret);
    const auto done = stream->handshakeUntil(QDeadlineTimer(timeout));
    if (done)
        return stream;
    if (stream->isWrongSecret())
        return Error(ErrorCode::NotAuthorised,
                     QString("the code is wrong: it must be the one that %1 shows now").arg(address.host));
    return Error(done.error().is(ErrorCode::TimedOut) ? ErrorCode::TimedOut : ErrorCode::Disconnected,
                 QString("no agreement with port %1 of %2: %3; is hermesctl keys pair waiting there?")
                     .arg(address.port)
                     .arg(address.host, done.error().message));
}

/// The other side counts the keys as taken over once it has sent that it knows of them.
Result<void> agree(PairingStream &stream, const QDeadlineTimer &deadline) {
    if (const auto sent = stream.send(pairingStored, deadline); !sent)
        return sent;
    const auto answer = stream.receive(pairingAccepted.size(), deadline);
    if (!answer)
        return answer.error();
    return *answer == pairingAccepted ? Result<void>()
                                      : Error(ErrorCode::InvalidRequest, "the other side does not accept");
}

Result<KeyBundle> take(PairingStream &stream, NewKeyFolder &folder) {
    const QDeadlineTimer deadline(longestTransfer);
    const auto json = stream.receive(KeyBundle::maxJsonBytes, deadline);
    if (!json)
        return json.error();
    const auto keys = KeyBundle::fromJson(*json);
    if (!keys)
        return keys.error();
    const SignalWatcher ignored(nullptr); // what is begun is ended in order, whoever asks for the end
    if (const auto staged = folder.stage(*keys); !staged)
        return staged.error();
    if (const auto agreed = agree(stream, deadline); !agreed)
        return Error(ErrorCode(agreed.error().code),
                     QString("%1; nothing was kept here: see with hermesctl keys list there whether the "
                             "certificate is revoked")
                         .arg(agreed.error().message));
    if (const auto kept = folder.keep(); !kept)
        return kept.error();
    return keys;
}

} // namespace

Result<void> keysJoin(const Arguments &arguments) {
    const auto address = PairingAddress::parse(arguments.words.first());
    if (!address)
        return address.error();
    const auto code = PairingCode::read(arguments.words.mid(1).join(QString()));
    if (!code)
        return code.error();
    NewKeyFolder folder(KeyFolder::usual());
    if (const auto free = folder.check(); !free)
        return free;
    const auto stream = secureStreamTo(*address, *code, arguments.timeout);
    if (!stream)
        return stream.error();
    const auto keys = take(**stream, folder);
    if (!keys)
        return keys.error();
    const PeerCertificate own = toPeer(QSslCertificate(keys->certificate));
    print(arguments,
          QJsonObject{
              {"folder", KeyFolder::usual()}, {"name", own.name}, {"role", own.role}, {"serial", own.serial}},
          QString("%1: the keys of %2 (%3); serial number %4.")
              .arg(KeyFolder::usual(), own.name, own.role, own.serial));
    return {};
}

} // namespace hermes::ctl
