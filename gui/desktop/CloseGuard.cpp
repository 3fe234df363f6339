#include "gui/desktop/CloseGuard.h"

#include "gui/desktop/panels/SettingsPanel.h"

#include <utility>

namespace hermes::desktop {
namespace {

constexpr std::chrono::milliseconds reconsider{20000};

} // namespace

CloseGuard::CloseGuard(DriveControl &drive, LayoutKeeper &keeper, const SettingsPanel &settings,
                       QObject *parent)
    : QObject(parent)
    , drive_(drive)
    , keeper_(keeper)
    , settings_(settings) {
    connect(&keeper, &LayoutKeeper::ended, this, [this] { // whether it was written or not
        if (!std::exchange(waits_, false))
            return;
        tried_.invalidate();
        Q_EMIT ready();
    });
}

QString CloseGuard::reasons() const {
    QStringList all;
    if (drive_.stopping().isOnItsWay())
        all << tr("STOP is not confirmed as yet, and nothing repeats it when this window is closed.");
    if (const QStringList unapplied = settings_.unapplied(); !unapplied.isEmpty())
        all << tr("Settings were changed and are not applied: %1.").arg(unapplied.join(", "));
    if (!keeper_.problem().isEmpty() && !keeper_.isWaiting())
        all << keeper_.problem() + '.';
    if (!all.isEmpty())
        all << tr("Close the window once more if that is meant.");
    return all.join(' ');
}

QString CloseGuard::objection() {
    const bool isWritten = keeper_.finish();
    const QString why = reasons();
    const bool isAgain = tried_.isValid() && !tried_.hasExpired(reconsider.count()) &&
                         (why.isEmpty() || why == said_); // another one is told, too
    if (isForced_ || isAgain || (isWritten && why.isEmpty()))
        return {};
    tried_.start();
    said_ = why;
    waits_ = why.isEmpty();
    return isWritten ? why : tr("%1 What was set is still being written.").arg(why).trimmed();
}

} // namespace hermes::desktop
