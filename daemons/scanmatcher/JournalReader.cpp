#include "daemons/scanmatcher/DriveJournal.h"
#include "protocol/serial/Crc32c.h"

#include <Eigen/Cholesky>

#include <QCborStreamReader>
#include <QJsonObject>

#include <cstring>
#include <map>

namespace hermes::scanmatcher {

using vectorlib::EdgeRaw2D;
using vectorlib::LoopCloser;
using vectorlib::Pose2D;
using vectorlib::PoseConstraint;
using vectorlib::Transformation2D;

namespace {

constexpr double farthest_m = 1e6, farthestSeen_m = 1e4, most = 1e15;
constexpr double maxOfScan = 100000; // points, edges

/// The numbers of a table, row by row.
template <typename T>
struct Rows {
    std::vector<T> numbers;
    std::size_t columns = 1;

    std::size_t size() const { return numbers.size() / columns; }
    const T *operator[](std::size_t row) const { return numbers.data() + row * columns; }
};

bool isCount(double v, double end) {
    return v >= 0 && v < end && v == std::floor(v);
}
bool areWithin(const double *v, int count, double limit) {
    return std::all_of(v, v + count, [limit](double x) { return std::abs(x) <= limit; });
}
bool areMotion(const double *v) {
    return areWithin(v, 2, farthest_m) && std::abs(v[2]) <= 10;
}
template <typename T>
bool isEdge(const T *v, double farthest) {
    const auto isNear = [&](int i) { return std::abs(double(v[i])) <= farthest; };
    const bool areSums = v[0] >= 1 && v[3] >= 0 && v[5] >= 0 && v[10] >= 0;
    return areSums && isNear(1) && isNear(2) && isNear(6) && isNear(7) && isNear(8) && isNear(9);
}

template <typename T>
EdgeRaw2D edgeOf(const T *v) {
    vectorlib::TlsSums sums;
    sums.n = double(v[0]);
    sums.mean = {double(v[1]), double(v[2])};
    sums.xx = double(v[3]);
    sums.xy = double(v[4]);
    sums.yy = double(v[5]);
    return {sums, {{double(v[6]), double(v[7])}, {double(v[8]), double(v[9])}}, double(v[10])};
}
Transformation2D motionOf(const double *v) {
    return {v[0], v[1], v[2]};
}
Pose2D poseOf(const double *v) {
    return {v[0], v[1], v[2]};
}

/// The content of a block.
class Block {
public:
    /// False where it is no map of tables.
    bool read(const QByteArray &content) {
        QCborStreamReader in(content);
        if (!in.isMap() || !in.enterContainer())
            return false;
        while (in.hasNext()) {
            QByteArray name, bytes;
            quint64 number = 0;
            if (!readText(in, content.size(), name))
                return false;
            if (in.isTag() && !in.next())
                return false;
            if (in.isUnsignedInteger()) {
                number = in.toUnsignedInteger();
                in.next();
                numbers_[name] = number;
            } else if (readBytes(in, content.size(), bytes)) {
                tables_[name] = bytes;
            } else {
                return false;
            }
        }
        return in.lastError() == QCborError::NoError;
    }
    /// An item that has bytes; nothing is made room for that is not there.
    static bool readBytes(QCborStreamReader &in, qint64 size, QByteArray &bytes) {
        if (!in.isByteArray() || !in.isLengthKnown() ||
            in.currentStringChunkSize() > size - in.currentOffset())
            return false;
        auto part = in.readByteArray();
        for (; part.status == QCborStreamReader::Ok; part = in.readByteArray())
            bytes += part.data;
        return part.status == QCborStreamReader::EndOfString;
    }
    quint64 number(const char *name) const {
        const auto found = numbers_.find(name);
        return found == numbers_.end() ? 0 : found->second;
    }
    /// No row where there is no such table; false where it has half a row, or a number that is none.
    template <typename T>
    bool rows(const journal::Table &table, Rows<T> &rows) const {
        rows.columns = std::size_t(table.columns);
        rows.numbers.clear();
        const auto found = tables_.find(table.name);
        if (found == tables_.end())
            return true;
        const QByteArray &bytes = found->second;
        if (std::size_t(bytes.size()) % (sizeof(T) * rows.columns) != 0)
            return false;
        rows.numbers.resize(std::size_t(bytes.size()) / sizeof(T));
        if (!bytes.isEmpty())
            std::memcpy(rows.numbers.data(), bytes.constData(), std::size_t(bytes.size()));
        return std::all_of(rows.numbers.begin(), rows.numbers.end(),
                           [](T v) { return std::abs(double(v)) <= most; });
    }

private:
    static bool readText(QCborStreamReader &in, qint64 size, QByteArray &text) {
        if (!in.isString() || !in.isLengthKnown() || in.currentStringChunkSize() > size - in.currentOffset())
            return false;
        auto part = in.readString();
        for (; part.status == QCborStreamReader::Ok; part = in.readString())
            text += part.data.toUtf8();
        return part.status == QCborStreamReader::EndOfString;
    }

    std::map<QByteArray, QByteArray> tables_;
    std::map<QByteArray, quint64> numbers_;
};

/// Puts a drive together again, block by block.
class Remembering {
public:
    std::vector<vectorlib::MapEdge> known;
    LoopCloser::Memory memory;
    std::vector<std::vector<EdgeRaw2D>> edges;
    std::vector<double> trust;

    bool begin(const Block &block) {
        Rows<double> rows;
        if (block.number(journal::mark) != journal::version || !block.rows(journal::known, rows))
            return false;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double *const v = rows[i];
            if (!isCount(v[0], most) || !isCount(v[1], most) || !isEdge(v + 2, farthest_m))
                return false;
            known.emplace_back(std::int64_t(v[0]), edgeOf(v + 2), std::int64_t(v[1]));
        }
        return true;
    }
    /// False, and nothing happened, where the block does not go on with what there is.
    bool add(const Block &block) {
        if (!read(block) || !areScans() || !areKeys() || !areMotions() || !isGraph() || !isProgress())
            return false;
        addScans();
        addKeys();
        addGraph();
        addProgress();
        return true;
    }

private:
    bool read(const Block &b) {
        return b.rows(journal::scans, scans_) && b.rows(journal::edges, edges_) &&
               b.rows(journal::keys, keys_) && b.rows(journal::points, points_) &&
               b.rows(journal::motions, motions_) && b.rows(journal::poses, poses_) &&
               b.rows(journal::weights, weights_) && b.rows(journal::since, since_) &&
               b.rows(journal::progress, progress_);
    }
    std::size_t keyEnd() const { return memory.keys.size() + keys_.size(); }
    std::size_t motionEnd() const { return memory.graph.constraints.size() + motions_.size(); }

    // Each is of the key scan before it, or one itself, in turn.
    bool areScans() const {
        std::size_t key = memory.keys.size(), edgesLeft = edges_.size(); // the next
        for (std::size_t i = 0; i < scans_.size(); ++i) {
            const double *const v = scans_[i];
            const std::size_t scan = memory.scans.size() + i;
            const bool isKey = key < keyEnd() && keys_[key - memory.keys.size()][0] == double(scan);
            key += isKey;
            if (key == 0 || v[0] != double(key - 1) || !areMotion(v + 1) || !(v[4] >= 0) ||
                !(v[5] >= 0 && v[5] <= 1) || !isCount(v[6], maxOfScan) || v[6] > double(edgesLeft))
                return false;
            edgesLeft -= std::size_t(v[6]);
        }
        for (std::size_t i = 0; i < edges_.size(); ++i)
            if (!isEdge(edges_[i], farthestSeen_m))
                return false;
        return key == keyEnd() && edgesLeft == 0;
    }
    bool areKeys() const {
        std::size_t left = points_.size();
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            const double *const v = keys_[k];
            if (!areMotion(v + 1) || !(v[4] >= 0 && v[5] >= 0 && v[6] >= 0) || !areMotion(v + 7) ||
                !(v[10] >= 0 && v[11] >= 0) || !isCount(v[12], maxOfScan) || v[12] > double(left))
                return false;
            left -= std::size_t(v[12]);
        }
        return left == 0 && std::all_of(points_.numbers.begin(), points_.numbers.end(),
                                        [](float p) { return std::abs(double(p)) <= farthestSeen_m; });
    }
    bool areMotions() const {
        for (std::size_t i = 0; i < motions_.size(); ++i) {
            const double *const v = motions_[i];
            const auto end = double(keyEnd());
            const bool isDefinite = informationOf(v).llt().info() == Eigen::Success;
            if (!isCount(v[0], end) || !isCount(v[1], end) || v[0] == v[1] || !areMotion(v + 2) ||
                !areWithin(v + 5, 6, 1e12) || !isDefinite || !isCount(v[11], 2) ||
                !(v[12] >= 0 && v[12] <= 1))
                return false;
        }
        return true;
    }
    bool isGraph() const {
        for (std::size_t k = 0; k < poses_.size(); ++k)
            if (!areMotion(poses_[k]))
                return false;
        return poses_.size() >= keys_.size() && poses_.size() <= keyEnd() && weights_.size() <= motionEnd() &&
               std::all_of(weights_.numbers.begin(), weights_.numbers.end(),
                           [](double w) { return w >= 0 && w <= 1; });
    }
    bool isProgress() const {
        if (since_.size() > 1 || progress_.size() > 1)
            return false;
        if (since_.size() == 1) {
            const double *const v = since_[0];
            if (!areMotion(v) || !(v[3] >= 0 && v[4] >= 0 && v[5] >= 0 && v[6] >= 0 && v[7] >= 0))
                return false;
        }
        const double *const v = progress_.numbers.data();
        return progress_.size() == 0 || (isCount(v[0], most) && isCount(v[1], v[0] + 1) && isCount(v[2], 2) &&
                                         isCount(v[3], 2) && isCount(v[4], double(keyEnd()) + 1));
    }
    static Eigen::Matrix3d informationOf(const double *v) {
        Eigen::Matrix3d m;
        m << v[5], v[6], v[7], v[6], v[8], v[9], v[7], v[9], v[10];
        return m;
    }

    void addScans() {
        std::size_t next = 0;
        for (std::size_t i = 0; i < scans_.size(); ++i) {
            const double *const v = scans_[i];
            memory.scans.push_back({std::size_t(v[0]), motionOf(v + 1), v[4]});
            trust.push_back(v[5]);
            edges.emplace_back();
            edges.back().reserve(std::size_t(v[6]));
            for (std::size_t end = next + std::size_t(v[6]); next < end; ++next)
                edges.back().push_back(edgeOf(edges_[next]));
        }
    }
    void addKeys() {
        std::size_t next = 0;
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            const double *const v = keys_[k];
            LoopCloser::Key key;
            key.scan = std::size_t(v[0]);
            key.motion = motionOf(v + 1);
            key.effort = v[4];
            key.varianceXY = v[5];
            key.varianceAlpha = v[6];
            key.tracked = poseOf(v + 7);
            key.way = v[10];
            key.doubt = v[11];
            std::vector<vectorlib::Vector2D<float>> points;
            for (std::size_t end = next + std::size_t(v[12]); next < end; ++next)
                points.emplace_back(points_[next][0], points_[next][1]);
            key.points = vectorlib::PackedPoints(points);
            memory.keys.push_back(std::move(key));
        }
    }
    void addGraph() {
        std::vector<PoseConstraint> &all = memory.graph.constraints;
        for (std::size_t i = 0; i < motions_.size(); ++i) {
            const double *const v = motions_[i];
            all.push_back(
                {std::size_t(v[0]), std::size_t(v[1]), motionOf(v + 2), informationOf(v), v[11] > 0, v[12]});
        }
        for (std::size_t i = 0; i < weights_.size(); ++i)
            all[all.size() - weights_.size() + i].weight = weights_[i][0];
        std::vector<Pose2D> &poses = memory.graph.poses;
        poses.resize(memory.keys.size());
        for (std::size_t k = 0; k < poses_.size(); ++k)
            poses[poses.size() - poses_.size() + k] = poseOf(poses_[k]);
    }
    // Where the block does not tell, as the drive went on: by the last scan.
    void addProgress() {
        memory.since = {};
        if (since_.size() == 1) {
            const double *const v = since_[0];
            memory.since = {motionOf(v), v[3], v[4], v[5], v[6], v[7]};
        } else if (!memory.scans.empty()) {
            const LoopCloser::OnTheWay &last = memory.scans.back();
            memory.since = {last.motion, last.effort, 0, last.effort, last.effort, last.effort};
        }
        if (progress_.size() == 1) {
            const double *const v = progress_[0];
            memory.progress = {
                {std::size_t(v[0]), std::size_t(v[1]), 0}, v[2] > 0, v[3] > 0, std::size_t(v[4])};
        }
    }

    Rows<double> scans_, keys_, motions_, poses_, weights_, since_, progress_;
    Rows<float> edges_, points_;
};

/// The content of the next item of the file; nothing where it is cut or damaged.
std::optional<QByteArray> nextContent(QCborStreamReader &in, qint64 size, bool isFirst) {
    if (isFirst && (!in.isTag() || quint64(in.toTag()) != journal::cbor || !in.next()))
        return std::nullopt;
    if (!in.isArray() || !in.isLengthKnown() || in.length() != 2 || !in.enterContainer() ||
        !in.isUnsignedInteger())
        return std::nullopt;
    const quint64 sum = in.toUnsignedInteger();
    QByteArray content;
    if (!in.next() || !Block::readBytes(in, size, content) || !in.leaveContainer() ||
        crc32c(content.constData(), std::size_t(content.size())) != sum)
        return std::nullopt;
    return content;
}

} // namespace

Result<RememberedDrive> readDriveJournal(const QByteArray &bytes, const QString &path) {
    Remembering all;
    qint64 whole = 0;
    while (whole < bytes.size()) {
        // Qt's reader ends with its first item.
        const QByteArray rest = QByteArray::fromRawData(bytes.constData() + whole, int(bytes.size() - whole));
        QCborStreamReader in(rest);
        const auto content = nextContent(in, rest.size(), whole == 0);
        Block block;
        if (!content || !block.read(*content) || !(whole == 0 ? all.begin(block) : all.add(block)))
            break;
        whole += in.currentOffset();
    }
    if (all.memory.scans.empty())
        return Error(ErrorCode::InputOutput,
                     QString("%1: byte %2: expected %3")
                         .arg(path)
                         .arg(whole)
                         .arg(whole == 0 ? QString("a drive's journal of version %1").arg(journal::version)
                                         : QString("the first scans of a drive")),
                     QJsonObject{{"path", path}});
    RememberedDrive result;
    result.drive.known = std::move(all.known);
    result.drive.restore(std::move(all.memory), std::move(all.edges));
    result.trust = std::move(all.trust);
    result.leftOut = bytes.size() - whole;
    return result;
}

} // namespace hermes::scanmatcher
