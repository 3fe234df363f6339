#include "gui/hermesctl/SignalsHeld.h"

#include <csignal>

namespace hermes::ctl {

struct SignalsHeld::State {
    sigset_t signals{};
};

SignalsHeld::SignalsHeld()
    : before_(std::make_unique<State>()) {
    sigset_t held;
    sigemptyset(&held);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaddset(&held, signal);
    ::pthread_sigmask(SIG_BLOCK, &held, &before_->signals);
}

SignalsHeld::~SignalsHeld() {
    ::pthread_sigmask(SIG_SETMASK, &before_->signals, nullptr);
}

} // namespace hermes::ctl
