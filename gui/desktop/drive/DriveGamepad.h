#pragma once

#include "gui/desktop/Layouts.h"
#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/drive/GamepadCalibration.h"

namespace hermes::desktop {

/// Drives by a gamepad: the left stick drives, the right one turns, as long as the left shoulder button (the
/// dead-man button) is held; B is STOP, always.
class DriveGamepad : public QObject {
    Q_OBJECT
public:
    /// How a calibration stands.
    enum class Step { None, Rest, Move };
    static constexpr std::chrono::milliseconds restFor{1000};

    /// kept: where calibrations are, each for its kind of gamepad.
    DriveGamepad(DriveControl &drive, Layouts &kept, QObject *parent);

    const Gamepad &pad() const { return pad_; }
    /// As they drive: calibrated, 0 where they rest.
    GamepadSticks sticks() const { return calibration_.apply(pad_.sticks()); }

    Step step() const { return step_; }
    /// Measures the sticks at rest for a second, then as they are moved; nothing drives meanwhile.
    void beginCalibration();
    /// With what was measured since. Error: the calibration of before holds.
    Result<void> endCalibration();
    void cancelCalibration() { enter(Step::None); }
    /// Forgets the calibration.
    void useDefaults();

Q_SIGNALS:
    void changed();

private:
    void steer();
    void enter(Step step);
    void sample();
    void load();
    void keep(const GamepadCalibration &calibration);

    DriveControl &drive_;
    Layouts &kept_;
    Gamepad pad_;
    QString kind_; ///< whose calibration it is
    GamepadCalibration calibration_;
    Step step_ = Step::None;
    bool mustRelease_ = false; ///< the dead-man button was held in a calibration
    QTimer resting_, sampling_;
    std::vector<GamepadSticks> atRest_, moved_;
};

} // namespace hermes::desktop
