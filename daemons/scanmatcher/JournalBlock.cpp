#include "daemons/scanmatcher/JournalBlock.h"

#include "protocol/serial/Crc32c.h"
#include "protocol/wire/CborWriter.h"
#include "protocol/wire/Fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hermes::scanmatcher::journal {

using vectorlib::EdgeRaw2D;
using vectorlib::LoopCloser;
using vectorlib::Pose2D;
using vectorlib::Transformation2D;
using vectorlib::Vector2D;

/// A table: its numbers, row by row; nothing where it has no row.
template <typename Number>
using Table = std::optional<std::vector<Number>>;

/// The tables of a block: 32 bit a number where they are in the sensor's frame. Poses and motions are x, y
/// (m), heading (rad).
struct Tables {
    std::optional<quint64> version;
    Table<double> known, scans, own, keys, motions, poses, weights, since, progress;
    Table<float> edges, points;
};

Fields<Tables> fieldsOf(Of<Tables>) {
    return Fields<Tables>()
        .add(mark, &Tables::version, "Version of the first block")
        .add("known", &Tables::known, "id, observations, and as an edge, in the map's frame")
        .add("scans", &Tables::scans, "key, motion since that key, effort, trust, edges")
        .add("own", &Tables::own,
             "Of each scan the edges, the first ones, that its own sensor saw; none: all")
        .add("edges", &Tables::edges, "n, mean x, y, moments xx, xy, yy, segment x1, y1, x2, y2, sigma")
        .add("keys", &Tables::keys,
             "scan, motion since the key before, effort, variances, tracked pose, way, doubt, points")
        .add("points", &Tables::points, "x, y")
        .add("motions", &Tables::motions,
             "from, to, motion, information (upper triangle), may be wrong, weight")
        .add("poses", &Tables::poses, "Of the last keys")
        .add("weights", &Tables::weights, "Of the last motions")
        .add("since", &Tables::since, "Motion since the last key, way, turned, variances, doubt")
        .add("progress", &Tables::progress,
             "Loops tried, closed, whether any was found and is news since the last correction, keys "
             "then");
}

namespace {

constexpr double farthest_m = 1.1e7, farthestSeen_m = 1e4, most_rad = 10, maxInformation = 1e12, most = 1e15;
constexpr double maxOfScan = 99999; // points, edges

/// Goes along a table: puts values behind its rows, or gives those that are there.
template <typename Number>
class Rows {
public:
    Rows(Table<Number> &table, bool isWriting)
        : table_(table)
        , isWriting_(isWriting) {}

    /// All was given, and was in its range.
    bool isDone() const { return isRight_ && (isWriting_ || left() == 0); }
    /// A row for each of the values, which when they are given are as many as there are, or this number.
    template <typename T, typename Row>
    void each(std::vector<T> &values, const Row &row, std::optional<std::size_t> count = {}) {
        if (isWriting_)
            return void(std::for_each(values.begin(), values.end(), row));
        if (count && isRight_) // else rows that say how many come, and none do, would take all memory
            values.reserve(std::min(*count, left()));
        while (isRight_ && left() > 0 && values.size() != count)
            row(values.emplace_back());
        isRight_ = isRight_ && (!count || values.size() == count);
    }

    /// One number of a row. Integers are whole numbers.
    template <typename T>
    void number(T &value, double least, double greatest) {
        if (isWriting_)
            return (table_ ? *table_ : table_.emplace()).push_back(Number(value));
        isRight_ = isRight_ && left() > 0;
        const double given = isRight_ ? double((*table_)[next_++]) : 0;
        const double end = std::min(greatest, double(std::numeric_limits<T>::max())); // 32 bit on some boards
        const bool isWhole = !std::is_integral_v<T> || given == std::floor(given);
        isRight_ = isRight_ && given >= least && given <= end && isWhole;
        if (isRight_)
            value = T(given);
    }
    template <typename... T>
    void positive(T &...values) {
        (number(values, 0, most), ...);
    }
    template <typename... T>
    void within(double limit, T &...values) {
        (number(values, -limit, limit), ...);
    }
    void pose(Pose2D &pose) {
        within(farthest_m, pose.x, pose.y);
        within(most_rad, pose.theta);
    }
    void motion(Transformation2D &motion) {
        Pose2D pose = motion.pose();
        this->pose(pose);
        motion = Transformation2D(pose);
    }
    void edge(EdgeRaw2D &edge, double farthest) {
        vectorlib::TlsSums &sums = edge.sums;
        Vector2D<double> begin = edge.segment.begin(), end = edge.segment.end();
        number(sums.n, 1, most);
        within(farthest, sums.mean.x, sums.mean.y);
        positive(sums.xx);
        within(most, sums.xy);
        positive(sums.yy);
        within(farthest, begin.x, begin.y, end.x, end.y);
        positive(edge.sigma);
        edge.segment = {begin, end};
    }

private:
    std::size_t left() const { return table_ ? table_->size() - next_ : 0; }

    Table<Number> &table_;
    const bool isWriting_;
    std::size_t next_ = 0;
    bool isRight_ = true;
};

/// From a block to its tables, or back. False: a row is cut, or a number is out of its range.
bool exchange(Tables &tables, Block &block, bool isWriting) {
    Rows<double> known(tables.known, isWriting), scans(tables.scans, isWriting), own(tables.own, isWriting),
        keys(tables.keys, isWriting), motions(tables.motions, isWriting), poses(tables.poses, isWriting),
        weights(tables.weights, isWriting), since(tables.since, isWriting),
        progress(tables.progress, isWriting);
    Rows<float> edges(tables.edges, isWriting), points(tables.points, isWriting);
    known.each(block.known, [&](vectorlib::MapEdge &edge) {
        known.positive(edge.id, edge.observations);
        known.edge(edge, farthest_m);
    });
    scans.each(block.scans, [&](Block::Scan &scan) {
        std::size_t count = scan.edges.size();
        scans.positive(scan.place.key);
        scans.motion(scan.place.motion);
        scans.positive(scan.place.effort);
        scans.number(scan.trust, 0, 1);
        scans.number(count, 0, maxOfScan);
        edges.each(
            scan.edges, [&](EdgeRaw2D &edge) { edges.edge(edge, farthestSeen_m); }, count);
    });
    const auto isJoint = [](const Block::Scan &scan) { return scan.own < scan.edges.size(); };
    if (isWriting ? std::any_of(block.scans.begin(), block.scans.end(), isJoint) : tables.own.has_value())
        for (Block::Scan &scan : block.scans)
            own.number(scan.own, 0, double(vectorlib::MappedDrive::all));
    keys.each(block.keys, [&](LoopCloser::Key &key) {
        std::vector<Vector2D<float>> seen;
        key.points.unpack(seen);
        std::size_t count = seen.size();
        keys.positive(key.scan);
        keys.motion(key.motion);
        keys.positive(key.effort, key.varianceXY, key.varianceAlpha);
        keys.pose(key.tracked);
        keys.positive(key.way, key.doubt);
        keys.number(count, 0, maxOfScan);
        points.each(
            seen, [&](Vector2D<float> &point) { points.within(farthestSeen_m, point.x, point.y); }, count);
        if (!isWriting)
            key.points = vectorlib::PackedPoints(seen);
    });
    motions.each(block.motions, [&](vectorlib::PoseConstraint &motion) {
        Eigen::Matrix3d &m = motion.information;
        motions.positive(motion.from, motion.to);
        motions.motion(motion.motion);
        motions.within(maxInformation, m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2));
        m = Eigen::Matrix3d(m.selfadjointView<Eigen::Upper>());
        motions.number(motion.mayBeWrong, 0, 1);
        motions.number(motion.weight, 0, 1);
    });
    poses.each(block.poses, [&](Pose2D &pose) { poses.pose(pose); });
    weights.each(block.weights, [&](double &weight) { weights.number(weight, 0, 1); });
    since.each(block.since, [&](LoopCloser::SinceKey &row) {
        since.motion(row.motion);
        since.positive(row.way, row.turned, row.varianceXY, row.varianceAlpha, row.doubt);
    });
    progress.each(block.progress, [&](LoopCloser::Progress &row) {
        progress.positive(row.counts.tried, row.counts.closed);
        progress.number(row.found, 0, 1);
        progress.number(row.news, 0, 1);
        progress.positive(row.corrected);
    });
    return known.isDone() && scans.isDone() && own.isDone() && keys.isDone() && motions.isDone() &&
           poses.isDone() && weights.isDone() && since.isDone() && progress.isDone() && edges.isDone() &&
           points.isDone();
}

} // namespace

QByteArray item(const QByteArray &content, bool isFirst) {
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

QByteArray encode(Block block) {
    Tables tables;
    tables.version = block.version;
    exchange(tables, block, true);
    CborWriter out;
    Type<Tables>::write(out, tables);
    return out.take();
}

std::optional<Block> decode(const QByteArray &content) {
    const auto value = WireValue::parseCbor(content, nullptr);
    ReadReport report;
    auto tables = value ? readMessage<Tables>(*value, report) : std::nullopt;
    Block block;
    if (!tables || !exchange(*tables, block, false))
        return std::nullopt;
    block.version = tables->version;
    return block;
}

} // namespace hermes::scanmatcher::journal
