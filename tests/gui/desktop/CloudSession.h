#pragma once

#include "gui/desktop/panels/CloudPanel.h"
#include "tests/gui/desktop/FakeDaemon.h"

namespace hermes {

using namespace desktop;

/// The panel alone, on a daemon that says what a test wants.
struct CloudSession {
    explicit CloudSession(const Mischief &mischief = {})
        : daemon(mischief) {
        panel.resize(640, 360);
        panel.show();
        fleet.add(daemon.address());
        QTRY_VERIFY(daemon.subscriptions("cloud") > 0);
    }
    QString summary() const { return panel.findChild<QLabel *>("cloudSummary")->text(); }
    const CloudModel &model() { return panel.model(); }

    FakeDaemon daemon;
    Fleet fleet;
    CloudPanel panel{fleet};
};

inline QByteArray cloudOf(const QByteArray &x, const QByteArray &y, const QByteArray &z,
                          const QByteArray &intensity = "[]", const QByteArray &laser = "[]") {
    return R"({"turn":1,"stamp":1718000000,"duration_s":0.1,"partial":false,"rays":100,"lost_packets":0,)"
           R"("frame":"lidar","replayed":false,"model":"HDL-32E","x":)" +
           x + ",\"y\":" + y + ",\"z\":" + z + ",\"intensity\":" + intensity + ",\"laser\":" + laser + '}';
}

/// A turn of an HDL-32E in a round room, without any thinning.
inline CloudMessage wholeTurn() {
    constexpr int firings = 2170, lasers = 32;
    CloudMessage cloud;
    cloud.model = "HDL-32E";
    cloud.header.rays = firings;
    for (int i = 0; i < firings; ++i)
        for (int laser = 0; laser < lasers; ++laser) {
            const double azimuth = 2 * M_PI * i / firings, elevation = (laser * 1.333 - 30.67) * M_PI / 180;
            const double range = 5 + 2 * std::sin(3 * azimuth);
            cloud.x.push_back(float(range * std::cos(azimuth)));
            cloud.y.push_back(float(range * std::sin(azimuth)));
            cloud.z.push_back(float(range * std::tan(elevation)));
            cloud.laser.push_back(quint16(laser));
            cloud.intensity.push_back(quint8(i % 256));
        }
    return cloud;
}

/// How many pixels have a colour that is neither grey nor the robot's.
inline int colouredPixels(QWidget &widget) {
    const QImage picture = widget.grab().toImage().convertToFormat(QImage::Format_RGB32);
    int count = 0;
    for (int y = 60; y < picture.height(); ++y) // below the legend
        for (int x = 0; x < picture.width(); ++x) {
            const QColor colour = picture.pixelColor(x, y);
            count += colour.saturation() > 120 && (colour.hue() > 60 && colour.hue() < 300);
        }
    return count;
}

/// A line that tests/bench reads.
inline void figure(const QByteArray &name, double value, const char *unit) {
    qInfo("figure %s: %.3g %s", name.constData(), value, unit);
}

} // namespace hermes
