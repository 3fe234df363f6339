#include "gui/hermesctl/Pairing.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

namespace hermes::ctl {
namespace {

const QByteArray alphabet = "23456789ABCDEFGHJKLMNPQRSTUVWXYZ"; // 5 bits each; no 0, O, 1, I
constexpr int length = 10;

const QByteArray salt = "hermes pairing 1";
constexpr uint64_t scryptN = 1 << 15, scryptR = 8, scryptP = 1; // 32 MB; RFC 7914
constexpr uint64_t scryptMemory = 64 << 20;

} // namespace

Result<PairingAddress> PairingAddress::parse(const QString &text) {
    PairingAddress made;
    QString port;
    if (text.startsWith('[')) {
        made.host = text.mid(1).section(']', 0, 0);
        port = text.section(']', 1);
    } else if (text.count(':') == 1) {
        made.host = text.section(':', 0, 0);
        port = ':' + text.section(':', 1);
    } else {
        made.host = text;
    }
    bool isPort = port.isEmpty();
    if (!isPort && port.startsWith(':')) {
        made.port = port.mid(1).toUShort(&isPort);
        isPort = isPort && made.port > 0;
    }
    if (made.host.isEmpty() || !isPort)
        return Error(ErrorCode::InvalidParams,
                     QString("\"%1\", expected HOST or HOST:PORT").arg(text.left(80)));
    return made;
}

QString PairingAddress::text() const {
    const bool isSix = host.contains(':');
    if (port == usualPairingPort)
        return host;
    return QString(isSix ? "[%1]:%2" : "%1:%2").arg(host).arg(port);
}

Result<PairingCode> PairingCode::make() {
    unsigned char random[length];
    if (RAND_priv_bytes(random, sizeof random) != 1)
        return Error(ErrorCode::InternalError, "the system gives no random numbers for a code");
    QByteArray characters;
    for (const unsigned char byte : random)
        characters.append(alphabet.at(byte % alphabet.size())); // 256 is a multiple: all equally often
    return PairingCode(characters);
}

Result<PairingCode> PairingCode::read(const QString &typed) {
    QByteArray characters;
    for (const QChar c : typed.toUpper()) {
        if (c == '-' || c.isSpace())
            continue;
        if (c.unicode() > 127 || !alphabet.contains(c.toLatin1()))
            return Error(ErrorCode::InvalidParams,
                         QString("a code has letters and digits, but neither 0, O, 1 nor I: \"%1\"")
                             .arg(typed.left(80)));
        characters.append(c.toLatin1());
    }
    if (characters.size() != length)
        return Error(ErrorCode::InvalidParams, QString("a code has %1 characters, \"%2\" has %3")
                                                   .arg(length)
                                                   .arg(typed.left(80))
                                                   .arg(characters.size()));
    return PairingCode(characters);
}

QString PairingCode::text() const {
    const QString all = QString::fromLatin1(characters_);
    return all.left(length / 2) + '-' + all.mid(length / 2);
}

Result<PairingSecret> PairingCode::secret() const {
    PairingSecret made;
    const bool done =
        EVP_PBE_scrypt(characters_.constData(), std::size_t(characters_.size()),
                       reinterpret_cast<const unsigned char *>(salt.constData()), std::size_t(salt.size()),
                       scryptN, scryptR, scryptP, scryptMemory, made.bytes.data(), made.bytes.size()) == 1;
    if (!done)
        return Error(ErrorCode::InternalError, "no key can be made of the code: are 32 MB of memory free?");
    return made;
}

} // namespace hermes::ctl
