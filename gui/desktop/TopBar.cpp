#include "gui/desktop/TopBar.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/drive/StopBanner.h"
#include "gui/desktop/widgets/AgedLabel.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/Quantities.h"
#include "protocol/wire/Fields.h"

#include <QComboBox>
#include <QKeyEvent>
#include <QPushButton>
#include <QSet>

namespace hermes::desktop {
namespace {

constexpr int longestHolder = 30, longestPower = 60;

/// The list of robots: its keys open it, for most of them drive elsewhere, and none of these is to choose
/// another robot unseen.
class RobotBox : public QComboBox {
protected:
    void keyPressEvent(QKeyEvent *event) override {
        static const QSet<int> opening{Qt::Key_Up,     Qt::Key_Down, Qt::Key_PageUp, Qt::Key_PageDown,
                                       Qt::Key_Return, Qt::Key_F4,   Qt::Key_Home,   Qt::Key_End};
        opening.contains(event->key()) ? showPopup() : event->ignore();
    }
};

/// The supervisor says that nobody wants it to run.
bool isMeantToRest(const ProcessStatus *process) {
    return process && (process->state == "stopped" || process->state == "disabled");
}

QString powerTip(const BatteryState &battery) {
    QString tip =
        TopBar::tr("The lower battery voltage, its charge and the time that is left, the sum of the motor "
                   "currents and the higher temperature of the controllers.");
    if (battery.charge && battery.left_s && battery.leftLeast_s && battery.chargeDeviation)
        tip +=
            TopBar::tr(" Charge %1 % +- %2 %; time left at the current of the last minute: %3, at least %4.")
                .arg(shortNumber(100 * *battery.charge, 0), shortNumber(100 * *battery.chargeDeviation, 0),
                     roughDurationText(*battery.left_s), roughDurationText(*battery.leftLeast_s));
    else if (!battery.reason.isEmpty())
        tip += TopBar::tr(" The charge is not known: %1.").arg(shortLine(battery.reason, 100));
    return tip;
}

} // namespace

TopBar::TopBar(Fleet &fleet, DriveControl &drive, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , drive_(drive)
    , powerFeed_(
          fleet, "power", {{"max_rate_hz", 1}}, [this](const TopicUpdate &u) { showPower(u.data); }, this)
    , robots_(named(new RobotBox, "robots", tr("The robot that the panels show and drive")))
    , link_(named(new PlainLabel, "link", tr("The longest time that a daemon of this robot takes to answer")))
    , control_(named(new AgedLabel, "lease"))
    , power_(named(new AgedLabel, "power", powerTip({})))
    , release_(
          named(new QPushButton(tr("&Release")), "release",
                tr("Ends the emergency stop and faults that hold the robot. The robot does not move by it.")))
    , stop_(named(new QPushButton(tr("STOP")), "stop",
                  tr("Emergency stop over the network (Space or F12). It does not replace a wired one."))) {
    setBackgroundRole(QPalette::Window); // a tool bar's is that of buttons
    robots_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
    stop_->setFocusPolicy(Qt::NoFocus);
    QFont big = stop_->font();
    big.setBold(true);
    big.setPointSizeF(1.3 * big.pointSizeF());
    stop_->setFont(big);
    stop_->setMinimumSize(QFontMetrics(big).horizontalAdvance("STOP pressed") + 40, 40); // nothing jumps

    link_->letElide(); // nothing pushes STOP out of sight
    control_->keepRoom(160);
    power_->keepRoom(280);

    auto *const label = new PlainLabel(tr("Ro&bot"));
    label->setBuddy(robots_);
    QBoxLayout *const row = inRow({label, robots_, link_, control_, power_, Part::room(), release_, stop_});
    for (const int place : {4, 3, 2}) // apart from each other
        row->insertSpacing(place, 12);
    setLayout(row);
    row->setContentsMargins(8, 0, 8, 0);

    connect(robots_, QOverload<int>::of(&QComboBox::activated), this, [this](int index) {
        fleet_.choose(fleet_.robotAt(robots_->itemData(index).toString()));
        Q_EMIT robotTaken();
    });
    connect(stop_, &QPushButton::pressed, &drive, &DriveControl::stop); // at once, not when it is let go
    connect(release_, &QPushButton::clicked, &drive, &DriveControl::release);
    connect(&fleet, &Fleet::changed, this, &TopBar::updateRobots);
    connect(&fleet, &Fleet::changed, this, &TopBar::updateLink);
    connect(&fleet, &Fleet::robotChosen, this, &TopBar::updateRobots);
    connect(&fleet, &Fleet::robotChosen, this, &TopBar::updateLink);
    connect(&powerFeed_, &TopicFeed::sourceChanged, power_, [this] {
        powerAge_.forget();
        power_->tell({});
    });
    connect(&drive, &DriveControl::changed, this, &TopBar::updateDrive);
    updateRobots();
    updateLink();
    updateDrive();
}

void TopBar::updateRobots() {
    std::vector<std::pair<QString, QString>> all, shown; // name and id
    for (const auto &robot : fleet_.robots())
        all.emplace_back(fleet_.titleOf(*robot), robot->id());
    for (int i = 0; i < robots_->count(); ++i)
        shown.emplace_back(robots_->itemText(i), robots_->itemData(i).toString());
    if (all != shown) {
        robots_->clear();
        for (const auto &[name, id] : all)
            robots_->addItem(name, id);
    }
    robots_->setCurrentIndex(fleet_.robot() ? robots_->findData(fleet_.robot()->id()) : -1);
    window()->setWindowTitle(fleet_.robot() ? tr("%1 - Hermes").arg(fleet_.titleOf(*fleet_.robot()))
                                            : tr("Hermes"));
}

void TopBar::updateLink() {
    double worst = -1;
    QString wrong;
    if (const Robot *const robot = fleet_.robot())
        for (const DaemonLink *daemon : robot->daemons()) {
            worst = std::max(worst, daemon->latency_ms());
            const ProcessStatus *const process = robot->process(*daemon);
            if (daemon->isSilent() ||
                (daemon->isKnown() && !daemon->isConnected() && !isMeantToRest(process)))
                wrong = tr("%1: %2").arg(daemon->name(), daemon->conditionWord());
        }
    theme::tint(*link_, QPalette::WindowText, theme::faultIf(!wrong.isEmpty()));
    link_->setText(!wrong.isEmpty() ? wrong
                   : worst < 0      ? tr("no link")
                                    : tr("link %1 ms").arg(worst, 0, 'f', worst < 10 ? 1 : 0));
}

void TopBar::updateDrive() {
    const QString holder = drive_.holder();
    if (!drive_.isPossible())
        control_->tell(tr("nothing to drive"));
    else
        control_->tell(holder.isEmpty() ? tr("control free")
                                        : tr("control: %1").arg(shortLine(holder, longestHolder)),
                       drive_.stateAge());
    release_->setVisible(drive_.isStopped());
    const StopControl &stopping = drive_.stopping();
    const bool isOnItsWay = stopping.phase() == StopPhase::Pressed || stopping.phase() == StopPhase::Sent;
    release_->setText(drive_.isReleaseAsked() ? tr("&Release?") : tr("&Release"));
    release_->setEnabled(!isOnItsWay || stopping.isLate()); // a stop that comes after its release holds
    stop_->setText(StopBanner::wordOf(drive_));
    const QString colours =
        drive_.isStopped() ? StopBanner::styleOf(drive_) : QString("background: #c4201d; color: white;");
    const QString style =
        "QPushButton { " + colours + " border-radius: 6px; padding: 4px 16px; }" +
        (drive_.isStopped()
             ? ""
             : "QPushButton:hover { background: #d93a36; } QPushButton:pressed { background: #8f1412; }");
    if (style != stop_->styleSheet())
        stop_->setStyleSheet(style);
}

void TopBar::showPower(WireView told) {
    powerAge_.heard(powerFeed_.source());
    ReadReport report;
    const auto power = readMessage<PowerMessage>(told, report);
    if (!power)
        return power_->tell(shortLine(tr("power: %1").arg(report.text()), longestPower), powerAge_);
    double volts = 0, amperes = 0, hottest = -300;
    for (const ControllerPower &controller : power->controllers) {
        if (!controller.ready)
            continue;
        volts = volts > 0 ? std::min(volts, controller.battery_v) : controller.battery_v;
        hottest = std::max(hottest, controller.temperature_c);
        for (const double current : controller.current_a)
            amperes += std::abs(current);
    }
    const BatteryState &battery = power->battery;
    QString charge;
    if (battery.charge && battery.left_s)
        charge =
            tr("   %1 %   %2").arg(shortNumber(100 * *battery.charge, 0), roughDurationText(*battery.left_s));
    power_->tell(hottest < -273 ? QString()
                                : tr("battery %1 V%2   %3 A   %4 °C")
                                      .arg(shortNumber(volts, 1), charge, shortNumber(amperes, 1),
                                           shortNumber(hottest, 0)),
                 powerAge_);
    power_->setToolTip(powerTip(battery));
}

} // namespace hermes::desktop
