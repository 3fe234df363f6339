#include "gui/desktop/panels/WheelsTest.h"

#include "common/client/DaemonAddress.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/desktop/widgets/Seen.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHostInfo>
#include <QPointer>
#include <QPushButton>

namespace hermes::desktop {
namespace {

QString spokenWheel(QString wheel) {
    return wheel.replace('_', ' ');
}

} // namespace

WheelsTest::WheelsTest(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , turn_(client_, "test of the wheels on " + QHostInfo::localHostName(), Client::defaultTimeout)
    , lifted_(named(new QCheckBox(tr("The robot is lifted, nothing\nand nobody touches a wheel")), "lifted"))
    , test_(named(new QPushButton(theme::icon("start"), tr("Test the wheels")), "testWheels"))
    , next_(named(new QPushButton(tr("Ne&xt")), "nextWheel"))
    , seenChoice_(named(new QComboBox, "seen", tr("What turned?")))
    , message_(new MessageLabel) {
    client_.setFrameLimit(DaemonLink::usualFrame);
    for (const QString &wheel : wheelNames())
        for (const bool isBackward : {false, true})
            seenChoice_->addItem(
                tr("%1 turned %2").arg(spokenWheel(wheel), isBackward ? tr("backward") : tr("forward")),
                QStringList{wheel, isBackward ? "b" : ""});
    seenChoice_->addItem(tr("none turned"), QStringList{"", ""});

    filled(this, inColumn({lifted_, test_, seenChoice_, next_, message_, Part::room()}));

    connect(lifted_, &QCheckBox::toggled, this, [this](bool isLifted) {
        if (!isLifted)
            giveUp(tr("the robot is not lifted"));
        updateButtons();
    });
    connect(test_, &QPushButton::clicked, this, [this] { isUnderWay() ? giveUp(tr("given up")) : begin(); });
    connect(next_, &QPushButton::clicked, this, &WheelsTest::onSeen);
    connect(&fleet, &Fleet::changed, this, &WheelsTest::updateButtons);
    connect(&fleet, &Fleet::moved, lifted_, [this] { lifted_->setChecked(false); });
    connect(&fleet, &Fleet::robotChosen, this, [this] {
        lifted_->setChecked(false);
        message_->hide();
        updateButtons();
    });
    updateButtons();
}

DaemonLink *WheelsTest::motors() const {
    return fleet_.robot() ? fleet_.robot()->withMethod("motor.wheels") : nullptr;
}

void WheelsTest::updateButtons() {
    const DaemonLink *const motors = this->motors();
    const QString why = motors ? motors->refusal("motor.wheels") : tr("No robot that can drive is connected");
    lifted_->setEnabled(why.isEmpty() || isUnderWay());
    test_->setEnabled((why.isEmpty() && lifted_->isChecked()) || isUnderWay());
    test_->setText(isUnderWay() ? tr("Give up") : tr("Test the wheels"));
    test_->setIcon(theme::icon(isUnderWay() ? "stop" : "start"));
    test_->setToolTip(!why.isEmpty() ? why : tr("Each wheel turns slowly for %1 s").arg(WheelTurn::turn_s));
    const bool isAsked = isUnderWay() && !turn_.isBusy();
    seenChoice_->setEnabled(isAsked);
    next_->setEnabled(isAsked);
}

void WheelsTest::begin() {
    DaemonLink *const motors = this->motors();
    if (!motors || turn_.isBusy())
        return;
    const QString address = asOwner(motors->address());
    motors->call("settings.get", {}, this, [=, link = QPointer(motors)](const Result<QJsonValue> &settings) {
        if (!settings)
            return message_->tell(settings.error().message, true);
        if (!link)
            return;
        link->call("motor.state", {}, this, [=](const Result<QJsonValue> &state) {
            if (isUnderWay() || !lifted_->isChecked())
                return;
            if (!state)
                return message_->tell(state.error().message, true);
            const auto plan = WheelPlan::from(settings->toObject(), state->toObject());
            if (!plan)
                return message_->tell(plan.error().message, true);
            plan_ = *plan;
            seen_.clear();
            client_.connectTo(address);
            wheel_ = plan_.wheels.first();
            turnNext();
        });
    });
}

void WheelsTest::turnNext() {
    message_->tell(
        tr("%1 is told to turn forward, at %2 rad/s").arg(spokenWheel(wheel_), shortNumber(plan_.speed, 2)));
    turn_.begin(wheel_, plan_.speed, [this](const Result<double> &measured) { onTurned(measured); });
    updateButtons();
}

void WheelsTest::onTurned(const Result<double> &measured) {
    if (isUnderWay() && measured) {
        message_->tell(tr("%1 was told to turn forward; its encoder tells %2 rad/s. What turned?")
                           .arg(spokenWheel(wheel_), shortNumber(*measured, 2)),
                       false, true);
        seenChoice_->setCurrentIndex(2 * wheelNames().indexOf(wheel_));
    } else if (isUnderWay()) {
        giveUp(measured.error().message);
    }
    updateButtons();
}

void WheelsTest::onSeen() {
    if (!isUnderWay() || turn_.isBusy())
        return;
    const QStringList choice = seenChoice_->currentData().toStringList();
    seen_[wheel_] = {choice[0], choice[1] == "b"};
    wheel_ = plan_.wheels.value(plan_.wheels.indexOf(wheel_) + 1);
    if (!wheel_.isEmpty())
        return turnNext();
    client_.close();
    lifted_->setChecked(false);
    const auto changes = wheelSettings(plan_.settings, seen_);
    if (!changes)
        return message_->tell(changes.error().message, true);
    message_->tell(changes->isEmpty() ? tr("All wheels turn as they are told; nothing needs a change.")
                                      : tr("What is to change is shown; Apply writes it."));
    Q_EMIT ended(*changes);
}

void WheelsTest::giveUp(const QString &why) {
    if (!isUnderWay())
        return;
    wheel_.clear();
    message_->tell(tr("The test of the wheels has ended: %1").arg(why), true);
    lifted_->setChecked(false);
    if (turn_.isBusy())
        turn_.giveUp(); // the connection is needed for it
    updateButtons();
}

void WheelsTest::onSight(bool isInSight) {
    if (isInSight)
        return;
    giveUp(tr("it is not in sight"));
    lifted_->setChecked(false);
}

void WheelsTest::showEvent(QShowEvent *event) {
    if (const QDockWidget *const dock = dockOf(*this))
        connect(dock, &QDockWidget::visibilityChanged, this, &WheelsTest::onSight, Qt::UniqueConnection);
    QWidget::showEvent(event);
}

void WheelsTest::hideEvent(QHideEvent *event) {
    onSight(false);
    QWidget::hideEvent(event);
}

} // namespace hermes::desktop
