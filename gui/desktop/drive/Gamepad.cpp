#define SDL_MAIN_HANDLED
#include "gui/desktop/drive/Gamepad.h"

#include "gui/desktop/widgets/ForeignText.h"

#include <SDL2/SDL.h>
#include <utility>

namespace hermes::desktop {
namespace {

constexpr int longestPadName = 40;
constexpr int maxEvents = 1000; // of one turn: a broken device is not to hold the window

constexpr std::array<SDL_GameControllerAxis, gamepadAxes> stickAxes{
    SDL_CONTROLLER_AXIS_LEFTX, SDL_CONTROLLER_AXIS_LEFTY, SDL_CONTROLLER_AXIS_RIGHTX};

} // namespace

Gamepad::Gamepad(QObject *parent)
    : QObject(parent) {
    SDL_SetMainReady();
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1"); // SDL has no window of its own
    if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0) {
        problem_ = tr("Gamepads cannot be used: %1").arg(QString::fromUtf8(SDL_GetError()));
        return;
    }
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &Gamepad::poll);
    timer_.start(searchPeriod);
}

Gamepad::~Gamepad() {
    if (!problem_.isEmpty())
        return;
    if (pad_)
        SDL_GameControllerClose(pad_); // who listens may be gone
    SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

void Gamepad::poll() {
    bool isStop = false;
    SDL_Event event;
    for (int i = 0; i < maxEvents && SDL_PollEvent(&event) != 0; ++i) {
        if (event.type == SDL_CONTROLLERBUTTONDOWN && pad_ && event.cbutton.which == device_ &&
            event.cbutton.button == SDL_CONTROLLER_BUTTON_B)
            isStop = true;
    }
    if (pad_ && !SDL_GameControllerGetAttached(pad_))
        close();
    for (int i = 0; i < SDL_NumJoysticks() && !pad_; ++i)
        if (SDL_IsGameController(i))
            open(i);
    if (isStop)
        Q_EMIT stopPressed();
    if (pad_)
        read();
}

void Gamepad::open(int device) {
    pad_ = SDL_GameControllerOpen(device);
    if (!pad_)
        return;
    SDL_Joystick *const joystick = SDL_GameControllerGetJoystick(pad_);
    device_ = SDL_JoystickInstanceID(joystick);
    name_ = shortLine(QString::fromUtf8(SDL_GameControllerName(pad_)), longestPadName);
    std::array<char, 33> text{};
    SDL_JoystickGetGUIDString(SDL_JoystickGetGUID(joystick), text.data(), int(text.size()));
    kind_ = QString::fromLatin1(text.data());
    timer_.start(period);
    Q_EMIT changed();
}

void Gamepad::close() {
    if (!pad_)
        return;
    SDL_GameControllerClose(std::exchange(pad_, nullptr));
    device_ = -1;
    name_.clear();
    kind_.clear();
    sticks_ = {};
    isDeadManHeld_ = false;
    timer_.start(searchPeriod);
    Q_EMIT changed();
}

void Gamepad::read() {
    GamepadSticks sticks;
    for (std::size_t i = 0; i < gamepadAxes; ++i)
        sticks[i] = std::max(-1.0, SDL_GameControllerGetAxis(pad_, stickAxes[i]) / 32767.0);
    const bool isHeld = SDL_GameControllerGetButton(pad_, SDL_CONTROLLER_BUTTON_LEFTSHOULDER) != 0;
    if (sticks == sticks_ && isHeld == isDeadManHeld_)
        return;
    sticks_ = sticks;
    isDeadManHeld_ = isHeld;
    Q_EMIT changed();
}

} // namespace hermes::desktop
