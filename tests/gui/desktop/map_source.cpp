// A daemon with the topics of a scan matcher and a scanner, of any size and at any rate: what the operator's
// window is measured with.
#include "common/daemon/Daemon.h"

#include <QTimer>
#include <cmath>

using namespace hermes;

class MapSource : public Daemon {
public:
    MapSource()
        : Daemon({"mapsource", "Map source", "A map of any size, a scan of any size, at any rate", 7498}) {
        addSetting(Field::integer("edges", "Edges of the map").range(0, 1000000).byDefault(20000));
        addSetting(Field::integer("points", "Points of a scan").range(0, 100000).byDefault(2000));
        addSetting(Field::number("rate_hz", "Scans a second").range(0.1, 10000).byDefault(10));
        addSetting(
            Field::integer("records", "Records in the log with each scan").range(0, 1000).byDefault(0));
        for (const char *const name : {"pose", "scan", "scan2d"})
            addTopic(Topic(name, name));
        addTopic(Topic("map", "map").snapshotParts([this](qint64 &cursor) {
            const bool isFirst = cursor == 0;
            const qint64 end = qMin<qint64>(cursor + 1000, settings().integer("edges"));
            QJsonArray edges;
            for (; cursor < end; ++cursor)
                edges.append(edge(cursor));
            cursor = cursor < settings().integer("edges") ? cursor : -1;
            return message(isFirst, edges);
        }));
        timer_.setTimerType(Qt::PreciseTimer);
        connect(&timer_, &QTimer::timeout, this, &MapSource::publishAll);
    }

protected:
    Result<void> start() override {
        settingsChanged({});
        setState(DaemonState::Running);
        return {};
    }
    void settingsChanged(const QStringList &) override {
        timer_.start(qMax(1, int(1000 / settings().number("rate_hz"))));
    }

private:
    /// Short walls, strewn over 100 m x 100 m.
    static QJsonObject edge(qint64 id) {
        const double x = std::fmod(double(id) * 61.803398875, 100) - 50,
                     y = std::fmod(double(id) * 7.548776662, 100) - 50, turn = double(id);
        return {{"id", id},
                {"x1", x},
                {"y1", y},
                {"x2", x + std::cos(turn)},
                {"y2", y + std::sin(turn)},
                {"n", 50},
                {"sigma", 0.01234567},
                {"observations", 17}};
    }
    QJsonObject message(bool isCleared, const QJsonArray &edges) {
        return {{"revision", revision_},
                {"cleared", isCleared},
                {"edges", edges},
                {"removed", QJsonArray()},
                {"size", settings().integer("edges")}};
    }
    void publishAll() {
        ++scan_;
        const double way = scan_ * 0.03, radius = 20;
        QJsonArray x, y, segments, pairs, changed;
        const int points = settings().integer("points");
        for (int i = 0; i < points; ++i) {
            const double angle = 2 * M_PI * i / points, distance = 8 + std::sin(9 * angle);
            x.append(distance * std::cos(angle));
            y.append(distance * std::sin(angle));
        }
        for (int i = 0; i < 40; ++i) {
            segments.append(QJsonArray{double(i), 0, double(i), 1});
            pairs.append(QJsonArray{i, i});
        }
        ++revision_;
        for (int i = 0; i < 20; ++i)
            changed.append(edge((scan_ * 20 + i) % qMax(1, settings().integer("edges"))));
        publish(
            "scan2d",
            QJsonObject{{"turn", scan_}, {"stamp", double(scan_)}, {"x", x}, {"y", y}, {"duration_s", 0.1}});
        publish("map", message(false, changed));
        const QJsonObject pose{{"x", radius * std::cos(way / radius)},
                               {"y", radius * std::sin(way / radius)},
                               {"theta", way / radius},
                               {"outcome", "matched"},
                               {"scan", scan_},
                               {"covariance", QJsonArray{1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e-5}}};
        publish(
            "scan",
            QJsonObject{{"stamp", double(scan_)},
                        {"pose", pose},
                        {"match", QJsonObject{{"pairs", pairs}, {"reliability", 0.9}, {"ambiguity", 0.001}}},
                        {"segments", segments}});
        publish("pose", pose);
        for (int i = 0; i < settings().integer("records"); ++i)
            publish("log", QJsonObject{{"stamp", double(scan_)},
                                       {"level", "info"},
                                       {"source", "source"},
                                       {"text", QString("record %1 of scan %2").arg(i).arg(scan_)}});
    }

    QTimer timer_;
    qint64 scan_ = 0, revision_ = 0;
};

int main(int argc, char **argv) {
    return runDaemon<MapSource>(argc, argv);
}
