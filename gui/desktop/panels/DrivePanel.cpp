#include "gui/desktop/panels/DrivePanel.h"

#include "gui/desktop/drive/Stick.h"
#include "gui/desktop/panels/GamepadRow.h"
#include "gui/desktop/widgets/AgedLabel.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QGridLayout>
#include <QLineEdit>
#include <QPushButton>
#include <QSlider>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr int highPanel = 480;      // pixels
constexpr int leastPercent = 5;     // of the slider
constexpr double leastSpeed = 0.01; // m/s

} // namespace

DrivePanel::DrivePanel(DriveControl &drive, DriveGamepad &gamepad, QWidget *parent)
    : QWidget(parent)
    , drive_(drive)
    , top_(new QBoxLayout(QBoxLayout::LeftToRight))
    , stick_(named(new Stick, "stick",
                   tr("Drag the knob to drive, the ring to turn. The arrow keys or WASD, Q "
                      "and E do the same.")))
    , limit_(named(new QSlider(Qt::Horizontal), "limit"))
    , speed_(named(new QLineEdit, "speedLimit"))
    , turn_(named(new PlainLabel, "turnLimit"))
    , control_(named(new AgedLabel, "control"))
    , problem_(named(new MessageLabel, "problem"))
    , takeOver_(named(new QPushButton(tr("Ta&ke over")), "takeOver",
                      tr("Takes the control from who has it; the robot stops first")))
    , blind_(named(new QPushButton(tr("Drive all the same")), "driveBlindly")) {
    control_->letWrap();
    top_->addWidget(stick_, 1);
    top_->addLayout(makeLimit());
    // As high as what is told usually: nothing above moves.
    QLayout *const control = inRow({{control_, 1}, {takeOver_, 0, Qt::AlignTop}});
    QWidget *const told = filled(new QWidget, inColumn({control, problem_, blind_, Part::room()}));
    told->setMinimumHeight(takeOver_->sizeHint().height() + 4 * fontMetrics().lineSpacing());
    filled(this, inColumn({{top_, 1}, new GamepadRow(gamepad), makeNumbers(), told}), 2);
    layout()->setContentsMargins(9, 2, 9, 2);
    for (QPushButton *const passing : {takeOver_, blind_})
        passing->setFocusPolicy(Qt::TabFocus); // a click leaves the keys to driving: the button goes
    connect(blind_, &QPushButton::clicked, &drive, &DriveControl::driveBlindly);

    connect(stick_, &Stick::moved, this,
            [this](const Twist2D &request, bool isHeld) { drive_.steer("stick", request, isHeld); });
    connect(takeOver_, &QPushButton::clicked, &drive, &DriveControl::takeOver);
    connect(&drive, &DriveControl::changed, this, &DrivePanel::update);
    update();
}

QWidget *DrivePanel::makeNumbers() {
    auto *const grid = new QGridLayout;
    grid->setVerticalSpacing(0);
    const QStringList names{tr("ahead\nm/s"), tr("left\nm/s"), tr("turn\nrad/s")};
    grid->addWidget(new PlainLabel(tr("commanded")), 1, 0);
    auto *const measured = named(new PlainLabel(tr("measured")), "measuredName");
    grid->addWidget(measured, 2, 0);
    for (int i = 0; i < 3; ++i) {
        grid->addWidget(new PlainLabel(names[i]), 0, i + 1, Qt::AlignRight);
        grid->addWidget(commanded_[i] = named(new PlainLabel, QString("commanded%1").arg(i)), 1, i + 1);
        grid->addWidget(measured_[i] = named(new AgedLabel, QString("measured%1").arg(i)), 2, i + 1);
        measured_[i]->setSilenceLabel(measured);
        for (PlainLabel *const number : std::initializer_list<PlainLabel *>{commanded_[i], measured_[i]}) {
            number->setAlignment(Qt::AlignRight);
            number->setMinimumWidth(fontMetrics().horizontalAdvance("-0.00")); // nothing jumps at a minus
        }
    }
    QWidget *const table = filled(new QWidget, grid);
    grid->setVerticalSpacing(0);
    return table;
}

QLayout *DrivePanel::makeLimit() {
    limit_->setRange(leastPercent, 100);
    limit_->setAccessibleName(tr("Speed limit"));
    speed_->setAccessibleName(tr("Speed limit in m/s"));
    speed_->setAlignment(Qt::AlignRight);
    speed_->setFixedWidth(fontMetrics().horizontalAdvance("00.000") + 16);
    connect(limit_, &QSlider::valueChanged, this, [this](int percent) { setLimit(percent / 100.0); });
    connect(speed_, &QLineEdit::editingFinished, this, &DrivePanel::takeTypedLimit);
    connect(speed_, &QLineEdit::textEdited, this, [this] { refuseLimit({}); });
    connect(speed_, &QLineEdit::returnPressed, speed_, &QWidget::clearFocus); // so that the keys drive
    auto *const label = new PlainLabel(tr("Speed li&mit"));
    label->setBuddy(speed_);
    auto *const grid = new QGridLayout;
    grid->setVerticalSpacing(2);
    grid->addWidget(label, 0, 0, 1, 2);
    grid->addWidget(speed_, 1, 0, Qt::AlignRight);
    grid->addWidget(new PlainLabel(tr("m/s")), 1, 1);
    grid->addWidget(turn_, 2, 0, 1, 2);
    grid->addWidget(limit_, 3, 0, 1, 2);
    return grid;
}

/// All of it is in sight on a low screen, and the stick is large on a high one.
void DrivePanel::resizeEvent(QResizeEvent *event) {
    top_->setDirection(height() < highPanel ? QBoxLayout::LeftToRight : QBoxLayout::TopToBottom);
    QWidget::resizeEvent(event);
}

void DrivePanel::takeTypedLimit() {
    if (!speed_->isModified())
        return;
    bool isNumber = false;
    const double speed = speed_->text().replace(',', '.').toDouble(&isNumber);
    const double most = drive_.most().vx;
    speed_->setModified(false);
    if (isNumber && std::isfinite(speed) && speed >= leastSpeed && most > 0)
        setLimit(speed / most);
    else
        refuseLimit(tr("\"%1\" is no speed: the limit stays as it was.").arg(shortLine(speed_->text(), 20)));
}

void DrivePanel::setLimit(double share) {
    refuseLimit(drive_.setLimit(share) ? QString() : tr("Let go first: what is held goes no faster."));
}

/// Told until there is something else to tell.
void DrivePanel::refuseLimit(const QString &why) {
    wrongLimit_ = why;
    problemThen_ = drive_.problem();
    update();
}

void DrivePanel::showLimit() {
    const Twist2D &most = drive_.most(), &limit = drive_.limit();
    const double share = most.vx > 0 ? limit.vx / most.vx : most.omega > 0 ? limit.omega / most.omega : 0;
    const bool isKnown = drive_.isPossible();
    const QSignalBlocker silence(limit_);
    limit_->setValue(qRound(100 * share));
    speed_->setEnabled(isKnown && most.vx > 0);
    const QString speed = isKnown ? shortNumber(limit.vx, 2) : QString();
    if (!speed_->isModified() && speed_->text() != speed)
        speed_->setText(speed); // which forgets what is selected
    turn_->setText(isKnown ? tr("%1 rad/s").arg(shortNumber(limit.omega, 2)) : tr("rad/s"));
    const QString toolTip =
        tr("The speed of the whole stick: ahead, sideways and turning. "
           "The largest of this robot are %1 m/s, %2 m/s and %3 rad/s.")
            .arg(shortNumber(most.vx, 2), shortNumber(most.vy, 2), shortNumber(most.omega, 2));
    for (QWidget *const widget : std::initializer_list<QWidget *>{limit_, speed_, turn_})
        widget->setToolTip(isKnown ? toolTip : tr("The speed of the whole stick"));
}

/// What moves the robot while nobody has the control.
QString DrivePanel::freeText() const {
    if (drive_.isStopped() || drive_.refusesForReplay())
        return tr("Control: free");
    if (drive_.mustLetGo())
        return tr("Control: free. Let go first.");
    return tr("Control: free. The stick takes it.");
}

void DrivePanel::update() {
    const auto numbers = [](const Twist2D &velocity) {
        std::array<QString, 3> texts;
        const double values[]{velocity.vx, velocity.vy, velocity.omega};
        for (std::size_t i = 0; i < 3; ++i)
            texts[i] = shortNumber(values[i], 2).replace("-0.00", "0.00");
        return texts;
    };
    const auto commanded = numbers(drive_.commanded()), measured = numbers(drive_.measured());
    const bool isMeasured = drive_.measuredAge().state() != Freshness::State::None;
    for (std::size_t i = 0; i < 3; ++i) {
        commanded_[i]->setText(commanded[i]);
        measured_[i]->tell(isMeasured ? measured[i] : QString(), drive_.measuredAge());
    }
    stick_->setEnabled(drive_.isPossible() && !drive_.isStopped());
    showLimit();
    const QString holder = drive_.holder();
    control_->tell(!drive_.isPossible() ? QString()
                   : holder.isEmpty()   ? freeText()
                   : drive_.wanted().isEmpty()
                       ? tr("Control: %1").arg(holder)
                       : tr("Control: %1; %2 asks for it").arg(holder, shortLine(drive_.wanted(), 40)),
                   drive_.isPossible() ? drive_.stateAge() : Freshness());
    takeOver_->setVisible(drive_.isHeldByOther());
    if (drive_.problem() != problemThen_)
        wrongLimit_.clear();
    QString problem = wrongLimit_.isEmpty() ? drive_.problem() : wrongLimit_;
    if (!drive_.latched().isEmpty())
        problem = (drive_.isStanding() ? tr("Stopped: %1. Release it above.")
                                       : tr("STOP holds, but that the robot stands is not known: %1."))
                      .arg(drive_.stopReason());
    problem_->setToolTip(toolTipOf(QStringList(drive_.latched().values()).join("; ")));
    blind_->setVisible(drive_.refusesForReplay());
    if (drive_.refusesForReplay())
        problem = tr("A replay is shown, not where the robot is: driving is off.");
    const bool isState = drive_.refusesForReplay() || !drive_.latched().isEmpty();
    if (std::exchange(told_, problem) != problem)
        problem_->tell(problem, true, isState || !drive_.isPossible());
}

} // namespace hermes::desktop
