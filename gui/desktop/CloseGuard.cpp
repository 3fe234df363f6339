#include "gui/desktop/CloseGuard.h"

#include "gui/desktop/panels/RecordPanel.h"
#include "gui/desktop/panels/SettingsPanel.h"

#include <QEventLoop>
#include <QTimer>
#include <utility>

namespace hermes::desktop {
namespace {

constexpr std::chrono::milliseconds reconsider{20000};
constexpr std::chrono::milliseconds longestWait{1000}; // more than a far robot takes to answer

} // namespace

CloseGuard::CloseGuard(DriveControl &drive, LayoutKeeper &keeper, const SettingsPanel &settings,
                       RecordPanel &recordings, QObject *parent)
    : QObject(parent)
    , drive_(drive)
    , keeper_(keeper)
    , settings_(settings)
    , recordings_(recordings) {
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
    if (const QString replays = drive_.replay().whenClosed(); !replays.isEmpty())
        all << replays;
    if (const QStringList unapplied = settings_.unapplied(); !unapplied.isEmpty())
        all << tr("Settings were changed and are not applied: %1.").arg(unapplied.join(", "));
    if (recordings_.isRecording())
        all << tr("A recording goes on when this window is closed.");
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
    if (isForced_ || isAgain || (isWritten && why.isEmpty())) {
        drive_.replay().endOwn();
        return {};
    }
    tried_.start();
    said_ = why;
    waits_ = why.isEmpty();
    return isWritten ? why : tr("%1 What was set is still being written.").arg(why).trimmed();
}

void CloseGuard::waitForLive() const {
    const SessionPlayer &player = recordings_.player();
    if (!player.isPlaying())
        return;
    QEventLoop wait;
    connect(&player, &SessionPlayer::ended, &wait, &QEventLoop::quit);
    QTimer::singleShot(longestWait, &wait, &QEventLoop::quit);
    wait.exec();
}

} // namespace hermes::desktop
