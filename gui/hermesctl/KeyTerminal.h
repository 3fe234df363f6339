#pragma once

#include <QByteArray>
#include <functional>
#include <memory>

namespace hermes::ctl {

/// The terminal at stdin gives each key at once and shows none, until this goes. Ctrl-C still is a signal;
/// Ctrl-Z and Ctrl-\ are keys: a program that they had stopped or killed could not tell the robot to stop.
class KeyTerminal {
public:
    /// take gets what was typed, arrows as escape sequences; once nothing: the terminal is gone.
    explicit KeyTerminal(const std::function<void(const QByteArray &)> &take);
    ~KeyTerminal();
    KeyTerminal(const KeyTerminal &) = delete;
    KeyTerminal &operator=(const KeyTerminal &) = delete;

    /// What was typed and not taken yet is as if it had not been; so is all that was typed before this began.
    void forget();
    /// Keys are taken no more.
    void end();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace hermes::ctl
