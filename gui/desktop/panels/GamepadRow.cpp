#include "gui/desktop/panels/GamepadRow.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QPainter>
#include <QPushButton>

namespace hermes::desktop {
namespace {

using Step = DriveGamepad::Step;

/// Both sticks as dots in their squares; the right one goes to the sides only.
class Sticks : public QWidget {
public:
    explicit Sticks(const DriveGamepad &gamepad)
        : gamepad_(gamepad) {
        setFixedSize(2 * side + gap, side);
        setAccessibleName(DriveGamepad::tr("The sticks of the gamepad"));
        setToolTip(DriveGamepad::tr("The sticks as they drive: left drives, right turns"));
    }

protected:
    void paintEvent(QPaintEvent *) override {
        const auto [leftX, leftY, rightX] = gamepad_.sticks();
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        draw(painter, 0, leftX, leftY);
        draw(painter, side + gap, rightX, 0);
    }

private:
    static constexpr int side = 40, gap = 8, dot = 5;

    void draw(QPainter &painter, int x, double right, double down) const {
        painter.setPen(palette().color(QPalette::Mid));
        painter.setBrush(palette().base());
        painter.drawRect(x, 0, side - 1, side - 1);
        const double reach = side / 2.0 - dot - 1;
        painter.setPen(Qt::NoPen);
        painter.setBrush(gamepad_.pad().isDeadManHeld() ? theme::colour(Condition::Busy)
                                                        : theme::colour(Condition::Unreachable));
        painter.drawEllipse(QPointF(x + side / 2.0 + reach * right, side / 2.0 + reach * down), dot, dot);
    }

    const DriveGamepad &gamepad_;
};

} // namespace

GamepadRow::GamepadRow(DriveGamepad &gamepad, QWidget *parent)
    : QWidget(parent)
    , gamepad_(gamepad)
    , sticks_(new Sticks(gamepad))
    , name_(named(new PlainLabel, "gamepad"))
    , calibrate_(named(new QPushButton, "calibrate",
                       tr("Measures where the sticks rest and how far they go; nothing drives meanwhile")))
    , other_(named(new QPushButton, "calibrateOther"))
    , message_(named(new MessageLabel, "gamepadMessage")) {
    name_->letWrap();
    for (QPushButton *const button : {calibrate_, other_})
        button->setFocusPolicy(Qt::TabFocus); // a click leaves the keys to driving
    filled(this, inColumn({inRow({sticks_, {name_, 1}}), inRow({calibrate_, other_}), message_}));
    connect(calibrate_, &QPushButton::clicked, this, &GamepadRow::go);
    connect(other_, &QPushButton::clicked, this, [this] {
        message_->hide();
        gamepad_.step() == Step::None ? gamepad_.useDefaults() : gamepad_.cancelCalibration();
    });
    connect(&gamepad, &DriveGamepad::changed, this, &GamepadRow::update);
    update();
}

void GamepadRow::go() {
    if (gamepad_.step() == Step::None) {
        message_->hide();
        return gamepad_.beginCalibration();
    }
    const auto done = gamepad_.endCalibration();
    message_->tell(done ? tr("Calibrated.") : done.error().message, !done);
}

QString GamepadRow::hint() const {
    switch (gamepad_.step()) {
    case Step::Rest:
        return tr("Let go of both sticks ...");
    case Step::Move:
        return tr("Move both sticks all the way round, then press Done.");
    case Step::None:
        break;
    }
    return gamepad_.pad().isDeadManHeld()
               ? tr("%1: drives").arg(gamepad_.pad().name())
               : tr("%1: hold the left shoulder button to drive, B is STOP").arg(gamepad_.pad().name());
}

void GamepadRow::update() {
    setVisible(gamepad_.pad().isPlugged());
    name_->setText(hint());
    const bool isIdle = gamepad_.step() == Step::None;
    calibrate_->setText(isIdle ? tr("Calibrate") : tr("Done"));
    calibrate_->setEnabled(gamepad_.step() != Step::Rest);
    other_->setText(isIdle ? tr("Defaults") : tr("Cancel"));
    other_->setToolTip(isIdle ? tr("Forgets the calibration of this gamepad")
                              : tr("Keeps the calibration of before"));
    sticks_->update();
}

} // namespace hermes::desktop
