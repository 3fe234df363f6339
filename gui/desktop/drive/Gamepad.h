#pragma once

#include <QObject>
#include <QTimer>
#include <array>

using SDL_GameController = struct _SDL_GameController;

namespace hermes::desktop {

/// The axes of a gamepad that drive.
enum class GamepadAxis { LeftX, LeftY, RightX };
constexpr std::size_t gamepadAxes = 3;
/// By GamepadAxis, each from -1 (left, up) to 1 as the device tells it.
using GamepadSticks = std::array<double, gamepadAxes>;

/// The first gamepad that is plugged in, read by SDL fifty times a second; when it goes, the next one.
class Gamepad : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds period{20};
    /// Until one is plugged in.
    static constexpr std::chrono::milliseconds searchPeriod{250};

    explicit Gamepad(QObject *parent);
    ~Gamepad() override;

    bool isPlugged() const { return pad_ != nullptr; }
    QString name() const { return name_; }
    /// The same for all of its kind.
    QString kind() const { return kind_; }
    const GamepadSticks &sticks() const { return sticks_; }
    /// The left shoulder button is down.
    bool isDeadManHeld() const { return isDeadManHeld_; }
    /// What hinders; empty: nothing.
    QString problem() const { return problem_; }

Q_SIGNALS:
    /// One was plugged in or went, a stick moved, or the dead-man button changed.
    void changed();
    /// B was pressed, however shortly.
    void stopPressed();

private:
    void poll();
    void open(int device);
    void close();
    void read();

    SDL_GameController *pad_ = nullptr;
    qint32 device_ = -1;
    QString name_, kind_, problem_;
    GamepadSticks sticks_{};
    bool isDeadManHeld_ = false;
    QTimer timer_;
};

} // namespace hermes::desktop
