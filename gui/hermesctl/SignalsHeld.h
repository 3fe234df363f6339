#pragma once

#include <memory>

namespace hermes::ctl {

/// Ctrl-C and the like have effect when this goes, so that what is begun is ended in order.
class SignalsHeld {
public:
    SignalsHeld();
    ~SignalsHeld();
    SignalsHeld(const SignalsHeld &) = delete;
    SignalsHeld &operator=(const SignalsHeld &) = delete;

private:
    struct State;
    std::unique_ptr<State> before_;
};

} // namespace hermes::ctl
