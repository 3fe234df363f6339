#include "gui/hermesctl/PairingCode.h"

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
