#include "common/ros/MapMessages.h"
#include "common/ros/Motion.h"
#include "common/ros/Scans.h"
#include "common/ros/States.h"
#include "protocol/ros/Definition.h"

#include <QCryptographicHash>
#include <QRegularExpression>

namespace hermes::ros {
namespace {

// As the nodes of ROS offer them that others were written for.
const Quality stream{};
const Quality newest{true, false, 1};
const Quality transforms{true, false, 100};
const Quality latched{true, true, 1};
const Quality logged{true, true, 1000, 10};

template <typename Out>
Mapping row(const QStringList &topics, const char *rosTopic, const Quality &quality, bool isOfEach,
            std::function<std::unique_ptr<Translator>()> make) {
    return {topics,
            QLatin1String(rosTopic),
            typeOf<Out>(),
            definitionOf<Out>(),
            typeHash(hashedTextOf<Out>()),
            quality,
            isOfEach,
            std::move(make)};
}

/// Messages of one topic, one by one; each daemon has a topic of its own.
template <typename In, typename Out, typename Convert>
Mapping each(const char *topic, const char *rosTopic, const Quality &quality = stream) {
    return row<Out>({QLatin1String(topic)}, rosTopic, quality, true,
                    [] { return std::make_unique<Each<In, Out, Convert>>(); });
}

template <typename Out, typename Made>
Mapping whole(const QStringList &topics, const char *rosTopic, const Quality &quality,
              bool isOfEach = false) {
    return row<Out>(topics, rosTopic, quality, isOfEach, [] { return std::make_unique<Made>(); });
}

} // namespace

QByteArray typeHash(const std::string &hashedText) {
    const QByteArray text = QByteArray::fromStdString(hashedText);
    return "RIHS01_" + QCryptographicHash::hash(text, QCryptographicHash::Sha256).toHex();
}

/// ROS takes letters, digits and underscores, no digit first.
QString Mapping::nameOf(const QString &daemon, bool isFirst) const {
    if (isFirst)
        return rosTopic;
    QString space = daemon;
    space.replace(QRegularExpression("[^A-Za-z0-9_]"), "_");
    return (space.isEmpty() || space[0].isDigit() ? "_" + space : space) + '/' + rosTopic;
}

const std::vector<Mapping> &mappings() {
    static const std::vector<Mapping> all = {
        each<ScanMessage, LaserScan, ScanBins>("scan2d", "scan"),
        each<CloudMessage, PointCloud, CloudPoints>("cloud", "points", newest),
        each<OdometryMessage, Odometry, OdometryOf>("odometry", "odom"),
        each<PoseMessage, PoseWithCovarianceStamped, MapPose>("pose", "pose"),
        each<WheelsMessage, JointState, JointsOf>("wheels", "joint_states"),
        each<PowerMessage, BatteryState, BatteryOf>("power", "battery"),
        each<FixMessage, NavSatFix, FixOf>("fix", "fix"),
        whole<TfMessage, Transforms>({"odometry", "pose", "wheels"}, "tf", transforms),
        whole<TfMessage, FixedTransforms>({}, "tf_static", latched),
        whole<String, Description>({}, "robot_description", latched),
        whole<OccupancyGrid, GridOfMap>({"map", "graph", "pose"}, "map", latched, true),
        whole<MarkerArray, WallsOfMap>({"map", "graph", "pose"}, "map_walls", latched, true),
        whole<DiagnosticArray, Diagnostics>({"status"}, "diagnostics", stream),
        row<Log>({"log"}, "rosout", logged, false,
                 [] { return std::make_unique<Each<LogMessage, Log, LogOf>>(); }),
    };
    return all;
}

} // namespace hermes::ros
