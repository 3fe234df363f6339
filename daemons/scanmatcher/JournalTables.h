#pragma once

#include "protocol/serial/Crc32c.h"

#include <QByteArray>
#include <QCborStreamWriter>

#include <cstdint>

namespace hermes::scanmatcher::journal {

/// What the first item of a journal says of it.
constexpr char mark[] = "hermes-journal";
constexpr int version = 1;

/// A table of a block: its name, and the numbers of a row. Poses and motions are x, y (m), heading (rad).
struct Table {
    const char *name;
    int columns;
};

/// 32 bit a number, in the sensor's frame: n, mean x, y, moments xx, xy, yy, segment x1, y1, x2, y2, sigma.
constexpr Table edges{"edges", 11}, points{"points", 2};
/// 64 bit a number; the same as an edge, after id and observations, in the map's frame.
constexpr Table known{"known", 13};
/// key, motion since that key, effort, trust, edges.
constexpr Table scans{"scans", 7};
/// scan, motion since the key before, effort, variances, tracked pose, way, doubt, points.
constexpr Table keys{"keys", 13};
/// from, to, motion, information (upper triangle), may be wrong, weight.
constexpr Table motions{"motions", 13};
/// Of the last keys, and of the last motions: those before keep theirs.
constexpr Table poses{"poses", 3}, weights{"weights", 1};
/// Motion since the last key, way, turned, variances, doubt.
constexpr Table since{"since", 8};
/// Loops tried, closed, whether any was found and is news since the last correction, keys then.
constexpr Table progress{"progress", 5};

/// Of typed arrays with the least byte first (RFC 8746), and of CBOR itself (RFC 8949).
constexpr std::uint64_t floats = 85, doubles = 86, cbor = 55799;

/// What a journal is a row of: an array of a check sum and the content. The first one begins the file.
inline QByteArray item(const QByteArray &content, bool isFirst = false) {
    QByteArray bytes;
    QCborStreamWriter out(&bytes);
    if (isFirst)
        out.append(QCborTag(cbor));
    out.startArray(2);
    out.append(quint64(crc32c(content.constData(), std::size_t(content.size()))));
    out.append(content);
    out.endArray();
    return bytes;
}

} // namespace hermes::scanmatcher::journal
