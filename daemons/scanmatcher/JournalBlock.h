#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/graph/MappedDrive.h"

#include <QByteArray>

#include <optional>
#include <vector>

namespace hermes::scanmatcher::journal {

/// What the first item of a journal says of it.
constexpr char mark[] = "hermes-journal";
constexpr quint64 version = 1;

/// The tag of CBOR itself (RFC 8949).
constexpr quint64 cbor = 55799;

/// What a journal is a row of: an array of a check sum and the content. The first one begins the file.
QByteArray item(const QByteArray &content, bool isFirst = false);

/// What a block tells of a drive: the scans and key scans since the block before.
struct Block {
    struct Scan {
        vectorlib::LoopCloser::OnTheWay place;
        double trust = 0;
        std::vector<vectorlib::EdgeRaw2D> edges;
        std::uint32_t own = vectorlib::MappedDrive::all; ///< edges that its sensor saw, the first ones
    };

    std::optional<quint64> version;        ///< of the first block
    std::vector<vectorlib::MapEdge> known; ///< of the first block
    std::vector<Scan> scans;
    std::vector<vectorlib::LoopCloser::Key> keys;
    std::vector<vectorlib::PoseConstraint> motions;
    std::vector<vectorlib::Pose2D> poses;                  ///< of the last keys: those before keep theirs
    std::vector<double> weights;                           ///< the same of the last motions
    std::vector<vectorlib::LoopCloser::SinceKey> since;    ///< none or one
    std::vector<vectorlib::LoopCloser::Progress> progress; ///< none or one
};

/// The content: a map of tables, which are typed arrays (RFC 8746), row by row.
QByteArray encode(Block block);
/// Nothing where it is no map of tables, a row is cut, or a number is out of its range.
std::optional<Block> decode(const QByteArray &content);

} // namespace hermes::scanmatcher::journal
