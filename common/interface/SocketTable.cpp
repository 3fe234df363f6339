#include "common/interface/SocketTable.h"

#include <QtEndian>
#include <cstring>

namespace hermes {
namespace {

enum Column { Local = 1, Remote = 2, User = 7, Inode = 9 };

/// As ADDRESS:PORT in hexadecimal; each 32 bits of an address are written as this machine's number of them.
bool isAt(const SocketEnd &end, const QByteArray &written) {
    const int colon = written.indexOf(':');
    const QByteArray bytes = QByteArray::fromHex(written.left(colon));
    quint32 words[4] = {};
    if (colon < 0 || (bytes.size() != 4 && bytes.size() != 16))
        return false;
    for (int i = 0; i < bytes.size() / 4; ++i)
        words[i] = qFromBigEndian<quint32>(bytes.constData() + 4 * i);
    Q_IPV6ADDR six{};
    std::memcpy(&six, words, sizeof six);
    const QHostAddress address =
        bytes.size() == 4 ? QHostAddress(qFromBigEndian(words[0])) : QHostAddress(six);
    return written.mid(colon + 1).toUInt(nullptr, 16) == end.port &&
           address.isEqual(end.address, QHostAddress::ConvertV4MappedToIPv4);
}

} // namespace

std::optional<unsigned> ownerInSocketTable(const QByteArray &table, const SocketEnd &from,
                                           const SocketEnd &to) {
    for (const QByteArray &line : table.split('\n')) {
        const QList<QByteArray> columns = line.simplified().split(' ');
        // A socket that its program has closed has no inode: it is of nobody, which reads as root.
        if (columns.size() <= Inode || columns[Inode] == "0" || !isAt(from, columns[Local]) ||
            !isAt(to, columns[Remote]))
            continue;
        bool isNumber = false;
        const unsigned user = columns[User].toUInt(&isNumber);
        return isNumber ? std::optional<unsigned>(user) : std::nullopt;
    }
    return std::nullopt;
}

} // namespace hermes
