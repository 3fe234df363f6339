#include "daemons/scanmatcher/DriveJournal.h"
#include "common/files/Folder.h"
#include "common/files/WriteAll.h"

#include <QDir>
#include <QFile>

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hermes::scanmatcher {

using vectorlib::EdgeRaw2D;
using vectorlib::LoopCloser;
using vectorlib::MappedDrive;
using vectorlib::Pose2D;
using vectorlib::PoseConstraint;
using vectorlib::Transformation2D;

namespace {

constexpr std::chrono::seconds writePeriod(4);
constexpr std::size_t scansOfBlock = 200, scansOfWrite = 5000;
constexpr int maxJournals = 100000;

/// The tables of a block.
class BlockWriter {
public:
    BlockWriter() { out_.startMap(); }

    void number(const char *name, quint64 value) {
        out_.append(QLatin1String(name));
        out_.append(value);
    }
    template <typename T>
    void table(const journal::Table &table, const std::vector<T> &numbers) {
        if (numbers.empty())
            return;
        out_.append(QLatin1String(table.name));
        out_.append(QCborTag(sizeof(T) == 4 ? journal::floats : journal::doubles));
        out_.appendByteString(reinterpret_cast<const char *>(numbers.data()),
                              qsizetype(numbers.size() * sizeof(T)));
    }
    /// The item of the file.
    QByteArray item(bool isFirst) {
        out_.endMap();
        return journal::item(content_, isFirst);
    }

private:
    QByteArray content_;
    QCborStreamWriter out_{&content_};
};

template <typename T>
void put(std::vector<T> &to, std::initializer_list<double> numbers) {
    for (const double number : numbers)
        to.push_back(T(number));
}
template <typename T>
void put(std::vector<T> &to, const EdgeRaw2D &e) {
    put(to, {e.sums.n, e.sums.mean.x, e.sums.mean.y, e.sums.xx, e.sums.xy, e.sums.yy, e.segment.begin().x,
             e.segment.begin().y, e.segment.end().x, e.segment.end().y, e.sigma});
}
void put(std::vector<double> &to, const Transformation2D &t) {
    put(to, {t.x(), t.y(), t.alpha()});
}
void put(std::vector<double> &to, const Pose2D &p) {
    put(to, {p.x, p.y, p.theta});
}

void putScans(BlockWriter &out, const MappedDrive &drive, const std::vector<double> &trust, std::size_t from,
              std::size_t to) {
    std::vector<double> scans;
    std::vector<float> edges;
    for (std::size_t i = from; i < to; ++i) {
        const LoopCloser::OnTheWay &scan = drive.loops.onTheWay()[i];
        put(scans, {double(scan.key)});
        put(scans, scan.motion);
        put(scans, {scan.effort, trust[i], double(drive.edges()[i].size())});
        for (const EdgeRaw2D &edge : drive.edges()[i])
            put(edges, edge);
    }
    out.table(journal::scans, scans);
    out.table(journal::edges, edges);
}

void putKeys(BlockWriter &out, const LoopCloser &loops, std::size_t from, std::size_t to) {
    std::vector<double> keys;
    std::vector<float> points;
    std::vector<vectorlib::Vector2D<float>> unpacked;
    for (std::size_t k = from; k < to; ++k) {
        const LoopCloser::Key &key = loops.keys()[k];
        put(keys, {double(key.scan)});
        put(keys, key.motion);
        put(keys, {key.effort, key.varianceXY, key.varianceAlpha});
        put(keys, key.tracked);
        put(keys, {key.way, key.doubt, double(key.points.size())});
        key.points.unpack(unpacked);
        for (const auto &p : unpacked)
            put(points, {double(p.x), double(p.y)});
    }
    out.table(journal::keys, keys);
    out.table(journal::points, points);
}

void putMotions(BlockWriter &out, const LoopCloser &loops, std::size_t from, std::size_t to) {
    std::vector<double> motions;
    for (std::size_t i = from; i < to; ++i) {
        const PoseConstraint &c = loops.graph().constraints[i];
        const Eigen::Matrix3d &m = c.information;
        put(motions, {double(c.from), double(c.to)});
        put(motions, c.motion);
        put(motions, {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2), double(c.mayBeWrong), c.weight});
    }
    out.table(journal::motions, motions);
}

void putGraph(BlockWriter &out, const LoopCloser &loops, std::size_t fromKey, std::size_t toKey,
              std::size_t fromMotion, std::size_t toMotion) {
    std::vector<double> poses, weights;
    for (std::size_t k = fromKey; k < toKey; ++k)
        put(poses, loops.graph().poses[k]);
    for (std::size_t i = fromMotion; i < toMotion; ++i)
        put(weights, {loops.graph().constraints[i].weight});
    out.table(journal::poses, poses);
    out.table(journal::weights, weights);
}

void putProgress(BlockWriter &out, const LoopCloser &loops) {
    std::vector<double> since, progress;
    const LoopCloser::SinceKey &s = loops.sinceKey();
    put(since, s.motion);
    put(since, {s.way, s.turned, s.varianceXY, s.varianceAlpha, s.doubt});
    const LoopCloser::Progress p = loops.progress();
    put(progress, {double(p.counts.tried), double(p.counts.closed), double(p.found), double(p.news),
                   double(p.corrected)});
    out.table(journal::since, since);
    out.table(journal::progress, progress);
}

QByteArray header(const MappedDrive &drive) {
    BlockWriter out;
    out.number(journal::mark, journal::version);
    std::vector<double> known;
    for (const vectorlib::MapEdge &edge : drive.known) {
        put(known, {double(edge.id), double(edge.observations)});
        put(known, static_cast<const EdgeRaw2D &>(edge));
    }
    out.table(journal::known, known);
    return out.item(true);
}

} // namespace

void DriveJournal::begin() {
    settle();
    file_.close();
    mark_ = Mark();
    isCorrected_ = false;
    const std::lock_guard lock(mutex_);
    state_ = JournalState();
}

void DriveJournal::write(const MappedDrive &drive, const std::vector<double> &trust) {
    if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return;
    settle();
    const bool isBehind = drive.loops.scans() - mark_.scans > scansOfWrite && state().fault.isEmpty();
    if (hasNews(drive) && (isBehind || Clock::now() - last_ >= writePeriod))
        start(drive, trust);
}

void DriveJournal::finish(const MappedDrive &drive, const std::vector<double> &trust) {
    settle();
    while (hasNews(drive)) {
        start(drive, trust);
        settle();
        if (!state().fault.isEmpty())
            return;
    }
}

JournalState DriveJournal::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

bool DriveJournal::hasNews(const MappedDrive &drive) const {
    return !file_.name.isEmpty() && (drive.loops.scans() > mark_.scans || isCorrected_);
}

void DriveJournal::start(const MappedDrive &drive, const std::vector<double> &trust) {
    last_ = Clock::now();
    underWay_ = mark_;
    const QByteArray bytes = encode(drive, trust, underWay_);
    writesCorrected_ = std::exchange(isCorrected_, false);
    writing_ = std::async(std::launch::async, [this, bytes] {
        Written written;
        written.isUsable = file_.append(bytes, written.fault);
        return written;
    });
}

// What the thread that writes came to.
void DriveJournal::settle() {
    if (!writing_.valid())
        return;
    const Written written = writing_.get();
    if (written.fault.isEmpty())
        mark_ = underWay_;
    else
        isCorrected_ = isCorrected_ || writesCorrected_;
    if (!written.isUsable) {
        file_.close();
        mark_ = Mark();
    }
    const std::lock_guard lock(mutex_);
    state_ = {file_.path, file_.size, mark_.scans, written.fault};
}

QByteArray DriveJournal::encode(const MappedDrive &drive, const std::vector<double> &trust,
                                Mark &mark) const {
    QByteArray bytes;
    if (!std::exchange(mark.isBegun, true))
        bytes = header(drive);
    const std::size_t end = std::min(drive.loops.scans(), mark.scans + scansOfWrite);
    do {
        const std::size_t scans = std::min(end, mark.scans + scansOfBlock);
        bytes += block(drive, trust, mark, scans, isCorrected_ && scans == end);
    } while (mark.scans < end);
    return bytes;
}

// The drive up to a number of scans; whole: with all poses and weights.
QByteArray DriveJournal::block(const MappedDrive &drive, const std::vector<double> &trust, Mark &mark,
                               std::size_t scans, bool isWhole) {
    const LoopCloser &loops = drive.loops;
    const std::size_t keys =
        scans == loops.scans() ? loops.keys().size() : loops.onTheWay()[scans - 1].key + 1;
    std::size_t motions = mark.motions;
    const std::vector<PoseConstraint> &all = loops.graph().constraints;
    while (motions < all.size() && std::max(all[motions].from, all[motions].to) < keys)
        ++motions;
    BlockWriter out;
    putScans(out, drive, trust, mark.scans, scans);
    putKeys(out, loops, mark.keys, keys);
    putMotions(out, loops, mark.motions, motions);
    putGraph(out, loops, isWhole ? 0 : mark.keys, keys, isWhole ? 0 : motions, motions);
    if (scans == loops.scans())
        putProgress(out, loops);
    mark.scans = scans;
    mark.keys = keys;
    mark.motions = motions;
    return out.item(false);
}

bool DriveJournal::File::open(QString &fault) {
    if (const Result<void> made = makeFolder(folder); !made) {
        path.clear();
        fault = made.error().message;
        return false;
    }
    const int dot = name.lastIndexOf('.');
    for (int i = 1; i < maxJournals; ++i) {
        const QString numbered =
            i == 1 ? name : QString("%1-%2%3").arg(name.left(dot)).arg(i).arg(name.mid(dot));
        path = QDir(folder).absoluteFilePath(numbered);
        number = ::open(QFile::encodeName(path).constData(),
                        O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_APPEND | O_CLOEXEC, 0644);
        if (number >= 0 || errno != EEXIST)
            break;
    }
    size = 0;
    if (number < 0) {
        fault = QString("%1: cannot be made: %2").arg(path, qt_error_string());
        path.clear();
        return false;
    }
    const int parent = ::open(QFile::encodeName(folder).constData(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (parent >= 0) {
        ::fsync(parent); // so that the name is on the disk, too
        ::close(parent);
    }
    return true;
}

bool DriveJournal::File::append(const QByteArray &bytes, QString &fault) {
    if (number < 0 && !open(fault))
        return true;
    struct stat status {};
    if (::fstat(number, &status) != 0 || status.st_nlink == 0) {
        fault = path + ": was removed; a new journal begins with the whole drive";
        return false;
    }
    if (size + bytes.size() > largestJournal) {
        fault = QString("%1: would have more than %2 bytes: the rest of the drive is not in it")
                    .arg(path)
                    .arg(largestJournal);
        return true;
    }
    if (writeAll(number, bytes) && ::fdatasync(number) == 0) {
        size += bytes.size();
        return true;
    }
    fault = QString("%1: cannot be written: %2").arg(path, qt_error_string());
    return ::ftruncate(number, size) == 0; // half a block would hide those after it
}

void DriveJournal::File::close() {
    if (number >= 0)
        ::close(number);
    number = -1;
    size = 0;
    path.clear();
}

} // namespace hermes::scanmatcher
