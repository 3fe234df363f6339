#pragma once

#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/EightDrive.h"
#include "tests/gui/desktop/FakeDaemon.h"

namespace hermes {

using namespace desktop;

inline const QByteArray twoLoops = R"({"from":2,"to":118,"weight":0.9},{"from":30,"to":90,"weight":0.1})";
constexpr double usualDrift = 0.3;
constexpr int lastKeyScan = EightDrive::keyScans - 1;

/// The panel on a matcher that says what the test wants; the drive is at its end, not yet corrected.
struct EightSession {
    explicit EightSession(bool isAtEnd = true) {
        panel.resize(800, 600);
        panel.show();
        fleet.add(daemon.address());
        [&] {
            for (const char *const topic : {"map", "graph", "pose"})
                QTRY_VERIFY(daemon.subscriptions(topic) > 0);
            if (isAtEnd)
                drive();
        }();
    }
    void drive() {
        daemon.say("map", bent.map(1));
        for (int i = 0; i < EightDrive::keyScans; ++i) {
            daemon.say("graph", bent.graph(i + 1, i == 0, i, i + 1, i + 1, i == lastKeyScan ? twoLoops : ""));
            if (i % 30 != 0)
                continue;
            QTRY_COMPARE(model.graph().size(), i + 1);
            daemon.say("pose", bent.poseMessage(i, false, bent));
            QTRY_VERIFY(model.pose() && isAt(*model.pose(), bent.pose(i)));
        }
        QTRY_COMPARE(model.graph().size(), EightDrive::keyScans);
        daemon.say("pose", bent.poseMessage(lastKeyScan, false, bent));
        QTRY_VERIFY(model.pose() && isAt(*model.pose(), bent.pose(lastKeyScan)));
        QTRY_COMPARE(model.edges().size(), 2 * EightDrive::keyScans);
    }
    void sayCorrected(char what) {
        if (what == 'm')
            daemon.say("map", straight.map(2));
        else if (what == 'g')
            daemon.say("graph", straight.graph(200, true, 0, lastKeyScan + 1, lastKeyScan + 1, twoLoops));
        else
            daemon.say("pose", straight.poseMessage(lastKeyScan, true, bent));
    }
    /// Until what was said is taken: a message without sense behind it is counted, a pose is told.
    void waitTaken(char what) {
        if (what == 'p') {
            QTRY_VERIFY(isAt(*model.pose(), straight.pose(lastKeyScan)));
            return;
        }
        const quint64 before = model.ignored();
        daemon.say(what == 'm' ? "map" : "graph", "[]");
        QTRY_VERIFY(model.ignored() > before);
    }
    static bool isAt(const Pose2D &a, const EightDrive::Pose &b) {
        return std::hypot(a.x - b.x, a.y - b.y) < 1e-6;
    }
    static bool isAt(QPointF a, const EightDrive::Pose &b) {
        return std::hypot(a.x() - b.x, a.y() - b.y) < 1e-6;
    }
    /// How far the end of the drive is shown on its way from bent (0) to straight (1); NaN: not on it.
    double part(QPointF shown) const {
        const auto from = bent.pose(lastKeyScan), to = straight.pose(lastKeyScan);
        const double length = std::hypot(to.x - from.x, to.y - from.y);
        const double along =
            ((shown.x() - from.x) * (to.x - from.x) + (shown.y() - from.y) * (to.y - from.y)) / length;
        const double aside =
            ((shown.x() - from.x) * (to.y - from.y) - (shown.y() - from.y) * (to.x - from.x)) / length;
        return std::abs(aside) < 0.05 * length ? along / length : std::nan("");
    }
    QByteArray svg() {
        const QString file = folder.filePath("view.svg");
        return panel.exportTo(file).ok() ? contentOf(file) : QByteArray();
    }

    const EightDrive bent{usualDrift}, straight{0};
    QTemporaryDir folder;
    FakeDaemon daemon{Mischief{}};
    Fleet fleet;
    MapPanel panel{fleet};
    const MapModel &model = panel.model();
    MapView &view = panel.view();
};

inline QPointF pointOf(const Pose2D &pose) {
    return {pose.x, pose.y};
}

} // namespace hermes
