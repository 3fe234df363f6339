#include "gui/desktop/LayoutKeeper.h"

#include <QDir>
#include <QFileInfo>
#include <memory>

namespace hermes::desktop {
namespace {

constexpr std::chrono::seconds again{5};
constexpr std::chrono::milliseconds moment{20}; // is enough for most disks

Error keptElsewhere(const QString &file) {
    return Error(ErrorCode::NotReady,
                 QObject::tr("Another window keeps the layouts; what is set here is kept only until this "
                             "window is closed. Where there is no other window, remove %1.lock")
                     .arg(file));
}

Error changedElsewhere(const QString &file) {
    return Error(
        ErrorCode::InputOutput,
        QObject::tr("The layouts were changed by another window or program, and are left so; what is "
                    "set here is kept only until this window is closed: %1")
            .arg(file));
}

} // namespace

LayoutKeeper::LayoutKeeper(Layouts &layouts, QObject *parent)
    : QObject(parent)
    , layouts_(layouts)
    , lock_(layouts.file() + ".lock")
    , expected_(layouts.fingerprint()) {
    lock_.setStaleLockTime(0); // only that of a process that has ended is void
    since_.start();
    if (isKept() && !lock())
        setOutcome(keptElsewhere(layouts_.file()));
}

LayoutKeeper::~LayoutKeeper() {
    blockSignals(true); // who would show it has gone
    pool_.waitForDone();
    collect({});
    if (isKept() && (layouts_.isChanged() || !problem_.isEmpty()))
        begin();
    pool_.waitForDone();
    if (collect({}) && !problem_.isEmpty())
        qWarning("hermes-gui: %s", qPrintable(problem_));
}

void LayoutKeeper::keep() {
    if (!collect({}) || !isKept())
        return;
    const bool isToBeTriedAgain =
        !problem_.isEmpty() && since_.hasExpired(std::chrono::milliseconds(again).count());
    if (layouts_.isChanged() || isToBeTriedAgain)
        begin();
}

bool LayoutKeeper::finish() {
    if (!collect(moment))
        return false;
    keep();
    return collect(moment);
}

void LayoutKeeper::begin() {
    since_.start();
    const auto task = std::make_shared<std::packaged_task<Result<void>()>>(
        [this, taken = layouts_.take()] { return write(taken); });
    writing_ = task->get_future();
    pool_.start([this, task] {
        (*task)();
        QMetaObject::invokeMethod(this, [this] { collect({}); });
    });
}

/// False: another window holds it. Where nothing can be locked, nobody does.
bool LayoutKeeper::lock() {
    QDir().mkpath(QFileInfo(layouts_.file()).absolutePath());
    // A file of a process that has ended can be removed, whatever is in it.
    return lock_.isLocked() || lock_.tryLock() || (lock_.removeStaleLockFile() && lock_.tryLock()) ||
           lock_.error() != QLockFile::LockFailedError;
}

/// In the thread that writes.
Result<void> LayoutKeeper::write(const Layouts &taken) {
    if (!lock())
        return keptElsewhere(layouts_.file());
    const QByteArray found = Layouts::fingerprintOf(taken.file());
    if (!found.isEmpty() && found != expected_)
        return changedElsewhere(taken.file());
    const auto saved = taken.save();
    if (saved)
        expected_ = Layouts::fingerprintOf(taken.file());
    return saved;
}

void LayoutKeeper::setOutcome(const Result<void> &outcome) {
    problem_ = outcome ? QString() : outcome.error().message;
    isWaiting_ = !outcome && outcome.error().is(ErrorCode::NotReady);
}

bool LayoutKeeper::collect(std::chrono::milliseconds timeout) {
    if (!writing_.valid())
        return true;
    if (writing_.wait_for(timeout) != std::future_status::ready)
        return false;
    const QString before = problem_;
    setOutcome(writing_.get());
    if (!problem_.isEmpty() && problem_ != before)
        Q_EMIT failed(problem_);
    Q_EMIT ended();
    return true;
}

} // namespace hermes::desktop
