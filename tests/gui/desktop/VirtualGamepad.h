#pragma once

#include <SDL2/SDL.h>

namespace hermes {

/// A gamepad that SDL takes for a real one. There has to be a Gamepad, which starts SDL.
class VirtualGamepad {
public:
    VirtualGamepad()
        : index_(SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
                                           SDL_CONTROLLER_BUTTON_MAX, 0))
        , joystick_(SDL_JoystickOpen(index_))
        , instance_(SDL_JoystickInstanceID(joystick_)) {}
    ~VirtualGamepad() { unplug(); }

    bool isThere() const { return joystick_ != nullptr; }
    /// value: -1 to 1.
    void move(SDL_GameControllerAxis axis, double value) {
        SDL_JoystickSetVirtualAxis(joystick_, axis, Sint16(32767 * value));
    }
    void press(SDL_GameControllerButton button, bool isDown) {
        SDL_JoystickSetVirtualButton(joystick_, button, isDown ? SDL_PRESSED : SDL_RELEASED);
    }
    void unplug() {
        if (!joystick_)
            return;
        for (int i = 0; i < SDL_NumJoysticks(); ++i)
            if (SDL_JoystickGetDeviceInstanceID(i) == instance_)
                SDL_JoystickDetachVirtual(i);
        SDL_JoystickClose(joystick_);
        joystick_ = nullptr;
    }

private:
    int index_;
    SDL_Joystick *joystick_;
    SDL_JoystickID instance_;
};

} // namespace hermes
