#include "gui/desktop/LayoutKeeper.h"

#include <memory>
#include <utility>

namespace hermes::desktop {
namespace {

constexpr std::chrono::seconds again{5};
constexpr std::chrono::milliseconds moment{20}; // is enough for most disks

} // namespace

LayoutKeeper::LayoutKeeper(Layouts &layouts, QObject *parent)
    : QObject(parent)
    , layouts_(layouts) {}

LayoutKeeper::~LayoutKeeper() {
    blockSignals(true); // who would show it has gone
    pool_.waitForDone();
    collect({});
    if (layouts_.problem().isEmpty() && (layouts_.isChanged() || !problem_.isEmpty()))
        begin();
    pool_.waitForDone();
    if (collect({}) && !problem_.isEmpty())
        qWarning("hermes-gui: %s", qPrintable(problem_));
}

void LayoutKeeper::keep() {
    if (!collect({}) || !layouts_.problem().isEmpty())
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
        [taken = layouts_.take()] { return taken.save(); });
    writing_ = task->get_future();
    pool_.start([this, task] {
        (*task)();
        QMetaObject::invokeMethod(this, [this] { collect({}); });
    });
}

bool LayoutKeeper::collect(std::chrono::milliseconds patience) {
    if (!writing_.valid())
        return true;
    if (writing_.wait_for(patience) != std::future_status::ready)
        return false;
    const Result<void> done = writing_.get();
    const QString before = std::exchange(problem_, done ? QString() : done.error().message);
    if (!problem_.isEmpty() && problem_ != before)
        Q_EMIT failed(problem_);
    Q_EMIT ended();
    return true;
}

} // namespace hermes::desktop
