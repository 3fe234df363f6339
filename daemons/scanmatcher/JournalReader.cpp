#include "daemons/scanmatcher/DriveJournal.h"
#include "protocol/serial/Crc32c.h"

#include <Eigen/Cholesky>

#include <QCborStreamReader>
#include <QJsonObject>

#include <algorithm>
#include <iterator>

namespace hermes::scanmatcher {

using vectorlib::LoopCloser;

namespace {

/// Puts a drive together again, block by block.
class Remembering {
public:
    std::vector<vectorlib::MapEdge> known;
    LoopCloser::Memory memory;
    std::vector<std::vector<vectorlib::EdgeRaw2D>> edges;
    std::vector<std::uint32_t> own;
    std::vector<double> trust;

    /// False, and nothing happened, where the block does not go on with what there is.
    bool add(journal::Block &block) {
        if (!areScans(block) || !areMotions(block) || !isGraph(block))
            return false;
        for (journal::Block::Scan &scan : block.scans) {
            memory.scans.push_back(scan.place);
            trust.push_back(scan.trust);
            edges.push_back(std::move(scan.edges));
            own.push_back(scan.own);
        }
        append(memory.keys, block.keys);
        append(memory.graph.constraints, block.motions);
        memory.graph.poses.resize(memory.keys.size());
        std::copy(block.poses.rbegin(), block.poses.rend(), memory.graph.poses.rbegin());
        auto motion = memory.graph.constraints.rbegin();
        for (auto weight = block.weights.rbegin(); weight != block.weights.rend(); ++weight, ++motion)
            motion->weight = *weight;
        resume(block);
        return true;
    }

private:
    template <typename T>
    static void append(std::vector<T> &to, std::vector<T> &more) {
        std::move(more.begin(), more.end(), std::back_inserter(to));
    }
    std::size_t keyEnd(const journal::Block &block) const { return memory.keys.size() + block.keys.size(); }

    // Each is of the key scan before it, or one itself, in turn.
    bool areScans(const journal::Block &block) const {
        std::size_t key = memory.keys.size(); // the next
        for (std::size_t i = 0; i < block.scans.size(); ++i) {
            key +=
                key < keyEnd(block) && block.keys[key - memory.keys.size()].scan == memory.scans.size() + i;
            if (key == 0 || block.scans[i].place.key != key - 1)
                return false;
        }
        return key == keyEnd(block);
    }
    bool areMotions(const journal::Block &block) const {
        return std::all_of(block.motions.begin(), block.motions.end(), [&](const auto &motion) {
            return std::max(motion.from, motion.to) < keyEnd(block) && motion.from != motion.to &&
                   motion.information.llt().info() == Eigen::Success;
        });
    }
    bool isGraph(const journal::Block &block) const {
        const bool hasProgress = !block.progress.empty();
        return block.poses.size() >= block.keys.size() && block.poses.size() <= keyEnd(block) &&
               block.weights.size() <= memory.graph.constraints.size() + block.motions.size() &&
               block.since.size() <= 1 && block.progress.size() <= 1 &&
               (!hasProgress || (block.progress[0].counts.closed <= block.progress[0].counts.tried &&
                                 block.progress[0].corrected <= keyEnd(block)));
    }
    // Where the block does not tell, as the drive went on: by the last scan.
    void resume(const journal::Block &block) {
        memory.since = {};
        if (!block.since.empty()) {
            memory.since = block.since[0];
        } else if (!memory.scans.empty()) {
            const LoopCloser::OnTheWay &last = memory.scans.back();
            memory.since = {last.motion, last.effort, 0, last.effort, last.effort, last.effort};
        }
        if (!block.progress.empty())
            memory.progress = block.progress[0];
    }
};

/// The content of the next item of the file; nothing where it is cut or damaged.
std::optional<QByteArray> nextContent(QCborStreamReader &in, qint64 size, bool isFirst) {
    if (isFirst && (!in.isTag() || quint64(in.toTag()) != journal::cbor || !in.next()))
        return std::nullopt;
    if (!in.isArray() || !in.isLengthKnown() || in.length() != 2 || !in.enterContainer() ||
        !in.isUnsignedInteger())
        return std::nullopt;
    const quint64 sum = in.toUnsignedInteger();
    if (!in.next() || !in.isByteArray() || !in.isLengthKnown() ||
        in.currentStringChunkSize() > size - in.currentOffset()) // no room is made for what is not there
        return std::nullopt;
    QByteArray content;
    auto part = in.readByteArray();
    for (; part.status == QCborStreamReader::Ok; part = in.readByteArray())
        content += part.data;
    if (part.status != QCborStreamReader::EndOfString || !in.leaveContainer() ||
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
        auto block = content ? journal::decode(*content) : std::nullopt;
        if (!block || (whole == 0 ? block->version != journal::version : !all.add(*block)))
            break;
        if (whole == 0)
            all.known = std::move(block->known);
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
    result.drive.restore(std::move(all.memory), std::move(all.edges), std::move(all.own));
    result.trust = std::move(all.trust);
    result.leftOut = bytes.size() - whole;
    return result;
}

} // namespace hermes::scanmatcher
