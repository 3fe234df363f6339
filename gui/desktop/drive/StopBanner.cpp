#include "gui/desktop/drive/StopBanner.h"

namespace hermes::desktop {
namespace {

constexpr const char *red = "background: #d0100c; color: white;",
                     *amber = "background: #f0a000; color: black;",
                     *dark = "background: #6e1512; color: white;";

} // namespace

StopBanner::StopBanner(DriveControl &drive, const Sounds &sounds, QWidget *parent)
    : Banner(parent)
    , drive_(drive)
    , sounds_(sounds) {
    setObjectName("stopBanner");
    sound_.setInterval(1000);
    connect(&sound_, &QTimer::timeout, [this] { sounds_.beep(); });
    connect(&drive, &DriveControl::changed, this, &StopBanner::update);
    update();
}

QString StopBanner::wordOf(const DriveControl &drive) {
    if (!drive.isStopped())
        return tr("STOP");
    const QMap<StopPhase, QString> words{{StopPhase::Pressed, tr("STOP pressed")},
                                         {StopPhase::Sent, tr("STOP sent")},
                                         {StopPhase::Taken, tr("STOP taken")},
                                         {StopPhase::Confirmed, tr("STOPPED")}};
    return words.value(drive.stopping().phase(), tr("STOP holds")); // that it stands is not known as yet
}

QString StopBanner::styleOf(const DriveControl &drive) {
    const StopPhase phase = drive.stopping().phase();
    return drive.stopping().isLate()                             ? red
           : phase == StopPhase::Confirmed || !drive.isStopped() ? dark
                                                                 : amber;
}

void StopBanner::update() {
    QString text = drive_.stopping().text();
    if (text.isEmpty() && drive_.isStopped()) {
        const QString reason = drive_.stopReason();
        text = drive_.stopping().phase() == StopPhase::Confirmed ? tr("STOPPED") : tr("The robot brakes");
        text += reason.isEmpty() ? QString() : ": " + reason;
    }
    if (drive_.isReleaseAsked())
        text = tr("Not stopped from here: look at the robot, then press Release once more. ") + text;
    tell(inPlainWords(text), styleOf(drive_));
    if (!drive_.stopping().isLate()) {
        sound_.stop();
    } else if (!sound_.isActive()) {
        sounds_.beep();
        sound_.start();
    }
}

} // namespace hermes::desktop
