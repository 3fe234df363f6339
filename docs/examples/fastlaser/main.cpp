#include "common/Time.h"
#include "common/daemon/Daemon.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

#include <cmath>

using namespace hermes;

/// Stands for your driver: the next turn of 3,600 beams in a square room of 4 m.
ScanMessage readScan() {
    constexpr int beams = 3600;
    constexpr double period_s = 0.025;
    static quint64 turn = 0;
    ScanMessage scan;
    scan.header.turn = turn++;
    scan.header.stamp = stampNow() - period_s; // of the first beam
    scan.header.rays = beams;
    scan.t.emplace();
    for (int i = 0; i < beams; ++i) {
        const double angle = 2 * M_PI * i / beams;
        const double range = 2 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
        scan.x.push_back(float(range * std::cos(angle)));
        scan.y.push_back(float(range * std::sin(angle)));
        scan.t->push_back(float(period_s * i / beams));
    }
    return scan;
}

class FastLaser : public Daemon {
public:
    FastLaser()
        : Daemon({"fastlaser", "Fast laser", "Publishes 40 scans of 3,600 points a second", 7485}) {
        addTopic(
            Topic("scan2d", "Each turn, counter-clockwise, in the sensor's frame").carries<ScanMessage>());
        connect(&timer, &QTimer::timeout, this, [this] {
            const ScanMessage scan = readScan(); // a driver that waits needs a thread of its own
            publish("scan2d", scan, scan.header.stamp);
        });
    }

protected:
    Result<void> start() override {
        timer.setTimerType(Qt::PreciseTimer);
        timer.start(25);
        setState(DaemonState::Running);
        return {};
    }
    void stop() override { timer.stop(); }

private:
    QTimer timer;
};

int main(int argc, char **argv) {
    return runDaemon<FastLaser>(argc, argv);
}
