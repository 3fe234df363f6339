#include "daemons/scanmatcher/DriveJournal.h"
#include "common/files/Folder.h"
#include "common/recording/FileSync.h"

#include <QDir>

#include <algorithm>
#include <cerrno>

namespace hermes::scanmatcher {

using vectorlib::LoopCloser;
using vectorlib::MappedDrive;
using vectorlib::PoseConstraint;

namespace {

constexpr std::chrono::seconds writePeriod(4);
constexpr std::size_t scansOfBlock = 200, scansOfWrite = 5000;
constexpr int maxJournals = 100000;

template <typename T>
std::vector<T> part(const std::vector<T> &all, std::size_t from, std::size_t to) {
    return {all.begin() + std::ptrdiff_t(from), all.begin() + std::ptrdiff_t(to)};
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
    writing_ = std::async(std::launch::async, [this, bytes] { return file_.write(bytes); });
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
    state_ = {file_.isOpen() ? file_.path() : QString(), file_.isOpen() ? qint64(file_.size()) : 0,
              mark_.scans, written.fault};
}

QByteArray DriveJournal::encode(const MappedDrive &drive, const std::vector<double> &trust,
                                Mark &mark) const {
    QByteArray bytes;
    if (!std::exchange(mark.isBegun, true)) {
        journal::Block first;
        first.version = journal::version;
        first.known = drive.known;
        bytes = journal::item(journal::encode(std::move(first)), true);
    }
    const std::size_t end = std::min(drive.loops.scans(), mark.scans + scansOfWrite);
    do {
        const std::size_t scans = std::min(end, mark.scans + scansOfBlock);
        bytes +=
            journal::item(journal::encode(block(drive, trust, mark, scans, isCorrected_ && scans == end)));
    } while (mark.scans < end);
    return bytes;
}

// The drive up to a number of scans; whole: with all poses and weights.
journal::Block DriveJournal::block(const MappedDrive &drive, const std::vector<double> &trust, Mark &mark,
                                   std::size_t scans, bool isWhole) {
    const LoopCloser &loops = drive.loops;
    const std::vector<PoseConstraint> &all = loops.graph().constraints;
    const std::size_t keys =
        scans == loops.scans() ? loops.keys().size() : loops.onTheWay()[scans - 1].key + 1;
    std::size_t motions = mark.motions;
    while (motions < all.size() && std::max(all[motions].from, all[motions].to) < keys)
        ++motions;
    journal::Block block;
    for (std::size_t i = mark.scans; i < scans; ++i)
        block.scans.push_back({loops.onTheWay()[i], trust[i], drive.edges()[i], drive.own()[i]});
    block.keys = part(loops.keys(), mark.keys, keys);
    block.motions = part(all, mark.motions, motions);
    block.poses = part(loops.graph().poses, isWhole ? 0 : mark.keys, keys);
    for (std::size_t i = isWhole ? 0 : motions; i < motions; ++i)
        block.weights.push_back(all[i].weight);
    if (scans == loops.scans()) {
        block.since = {loops.sinceKey()};
        block.progress = {loops.progress()};
    }
    mark.scans = scans;
    mark.keys = keys;
    mark.motions = motions;
    return block;
}

QString DriveJournal::File::begin() {
    if (const Result<void> made = makeFolder(folder); !made)
        return made.error().message;
    const int dot = name.lastIndexOf('.');
    for (int i = 1; i < maxJournals; ++i) {
        const QString numbered =
            i == 1 ? name : QString("%1-%2%3").arg(name.left(dot)).arg(i).arg(name.mid(dot));
        if (create(QDir(folder).absoluteFilePath(numbered)) || errno != EEXIST)
            break;
    }
    if (!isOpen())
        return error();
    syncFolder(folder); // so that the name is on the disk, too
    return {};
}

DriveJournal::Written DriveJournal::File::write(const QByteArray &bytes) {
    if (!isOpen())
        if (const QString fault = begin(); !fault.isEmpty())
            return {true, fault};
    if (isRemoved())
        return {false, path() + ": was removed; a new journal begins with the whole drive"};
    if (isChanged())
        return {false,
                path() +
                    ": was moved or changed by another program; a new journal begins with the whole drive"};
    const quint64 whole = size();
    if (qint64(whole) + bytes.size() > largestJournal)
        return {true, QString("%1: would have more than %2 bytes: the rest of the drive is not in it")
                          .arg(path())
                          .arg(largestJournal)};
    if (append(bytes.constData(), std::size_t(bytes.size())) && sync())
        return {};
    const QString fault = error();
    return {truncate(whole), fault}; // half a block would hide those after it
}

} // namespace hermes::scanmatcher
