#pragma once

#include <QApplication>

namespace hermes::desktop {

/// The sounds of the window, which can be switched off.
class Sounds {
public:
    bool areOn() const { return areOn_; }
    void switchTo(bool on) { areOn_ = on; }
    /// The desktop's bell.
    void beep() const {
        if (areOn_)
            QApplication::beep();
    }

private:
    bool areOn_ = true;
};

} // namespace hermes::desktop
