#pragma once

#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/OpenWindow.h"

namespace hermes {

/// A window on two robots, red and blue, each of which is only a motor control.
class TwoRobots {
protected:
    void begin() {
        red_ = std::make_unique<FakeDaemon>(robotOf("red"));
        blue_ = std::make_unique<FakeDaemon>(robotOf("blue"));
    }
    void open() {
        window_ = std::make_unique<OpenWindow>();
        QVERIFY(window_->show());
        for (const FakeDaemon *const one : {red_.get(), blue_.get()})
            QVERIFY(window_->fleet.add(one->address()));
        QTRY_VERIFY(robot(*red_) && robot(*blue_));
    }
    void close() {
        window_.reset();
        blue_.reset();
        red_.reset();
    }
    desktop::Robot *robot(const FakeDaemon &daemon) const { return window_->fleet.robotAt(daemon.address()); }

    std::unique_ptr<FakeDaemon> red_, blue_;
    std::unique_ptr<OpenWindow> window_;

private:
    static Mischief robotOf(const QByteArray &name) {
        Mischief robot;
        robot.isMotors = true;
        robot.topics["processes"] = "{\"robot\":\"" + name + "\",\"processes\":[]}";
        return robot;
    }
};

} // namespace hermes
