#include "gui/desktop/drive/DriveGamepad.h"

#include <QGamepad>
#include <QGamepadManager>
#include <cmath>

namespace hermes::desktop {
namespace {

/// Sticks do not come back to the very middle.
double withoutPlay(double axis) {
    constexpr double play = 0.12;
    return std::abs(axis) < play ? 0 : (axis - std::copysign(play, axis)) / (1 - play);
}

} // namespace

DriveGamepad::DriveGamepad(DriveControl &drive, QObject *parent)
    : QObject(parent)
    , drive_(drive) {
    QGamepadManager *const manager = QGamepadManager::instance();
    connect(manager, &QGamepadManager::gamepadConnected, this, &DriveGamepad::plug);
    connect(manager, &QGamepadManager::gamepadDisconnected, this, [this](int device) {
        if (!pad_ || pad_->deviceId() != device)
            return;
        pad_->deleteLater();
        pad_ = nullptr;
        drive_.steer("gamepad", {}, false);
    });
    const QList<int> devices = manager->connectedGamepads();
    if (!devices.isEmpty())
        plug(devices.front());
}

void DriveGamepad::plug(int device) {
    if (pad_)
        return;
    pad_ = new QGamepad(device, this);
    const auto steer = [this] {
        drive_.steer("gamepad",
                     {-withoutPlay(pad_->axisLeftY()), -withoutPlay(pad_->axisLeftX()),
                      -withoutPlay(pad_->axisRightX())},
                     pad_->buttonL1());
    };
    connect(pad_, &QGamepad::axisLeftXChanged, this, steer);
    connect(pad_, &QGamepad::axisLeftYChanged, this, steer);
    connect(pad_, &QGamepad::axisRightXChanged, this, steer);
    connect(pad_, &QGamepad::buttonL1Changed, this, steer);
    connect(pad_, &QGamepad::buttonBChanged, this, [this](bool isDown) {
        if (isDown)
            drive_.stop();
    });
}

} // namespace hermes::desktop
