#include "tests/fuzz/FuzzInput.h"

#include <vectorlib/io/CarmenLog.h>

using namespace vectorlib;

/// A log that is read has finite poses, motions and points; one that is not says where.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    for (const bool skipDamaged : {false, true}) {
        std::istringstream in(fuzzText(data, size));
        CarmenOptions options;
        options.skipDamaged = skipDamaged;
        const auto log = readCarmenLog(in, "log", options);
        if (!log) {
            FUZZ_REQUIRE(log.error().message().rfind("log:", 0) == 0);
            continue;
        }
        FUZZ_REQUIRE(!log->scans.empty() && (skipDamaged || log->damaged == 0));
        FUZZ_REQUIRE((log->damaged > 0) == log->firstDamage.has_value());
        std::vector<Vector2D<float>> points;
        for (const CarmenScan &scan : log->scans) {
            scan.appendPoints(points);
            FUZZ_REQUIRE(scan.maxRange > 0 && std::isfinite(scan.stamp));
            FUZZ_REQUIRE(!scan.wheelMotion || scan.wheelMotion->isFinite());
        }
        for (const Vector2D<float> &p : points)
            FUZZ_REQUIRE(p.isFinite());
        const std::size_t last = log->scans.size() - 1;
        FUZZ_REQUIRE(log->referenceMotion(0, last).isFinite());
        const Pose2D mount = log->sensorOnRobot(CarmenOdometryKind::Raw);
        FUZZ_REQUIRE(std::isfinite(mount.x) && std::isfinite(mount.y) && std::isfinite(mount.theta));
        for (const auto kind : {CarmenOdometryKind::Raw, CarmenOdometryKind::Corrected})
            if (const auto motion = log->odometryMotion(0, last, kind))
                FUZZ_REQUIRE(motion->isFinite());
    }
    return 0;
}
