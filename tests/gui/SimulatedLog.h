#pragma once

#include "tests/vectorlib/RingBuilding.h"

/// A drive through a drawn building as a raw CARMEN log that tests may spoil; metres, radians, seconds.
struct SimulatedLog {
    struct Line {
        std::vector<double> ranges; ///< of 181 rays over half a turn
        QByteArray odometry;        ///< x y theta
        double stamp = 0;
        vectorlib::Pose2D truth;
        bool counts = true; ///< it is a scan of its own that shows something
    };
    std::vector<Line> lines;

    /// Wheels slip by 1 % and turn wrongly by 1 %.
    SimulatedLog(const ScanWorld &world, const std::vector<vectorlib::Pose2D> &way, std::mt19937 &random) {
        using vectorlib::Transformation2D;
        vectorlib::Pose2D told{3, -2, 1};
        for (std::size_t i = 0; i < way.size(); ++i) {
            const Transformation2D here(way[i]);
            if (i > 0) {
                const vectorlib::Pose2D step = (Transformation2D(way[i - 1]).inverse() * here).pose();
                told = (Transformation2D(told) *
                        Transformation2D(step.x * 0.99, step.y * 0.99, step.theta * 1.01))
                           .pose();
            }
            Line line;
            for (const auto &p : world.scan(here, random, {181, vectorlib::pi, 0.01, 1e9}))
                line.ranges.push_back(std::min(81.9, double(p.norm())));
            line.odometry = pose(told);
            line.stamp = 100 + 0.4 * double(i);
            line.truth = way[i];
            lines.push_back(line);
        }
    }
    static QByteArray pose(const vectorlib::Pose2D &p) {
        return QByteArray::number(p.x, 'f', 6) + ' ' + QByteArray::number(p.y, 'f', 6) + ' ' +
               QByteArray::number(p.theta, 'f', 6);
    }
    QByteArray text() const {
        QByteArray text;
        for (const Line &line : lines) {
            const QByteArray stamp = QByteArray::number(line.stamp, 'f', 6);
            text += "FLASER " + QByteArray::number(int(line.ranges.size()));
            for (const double range : line.ranges)
                text += ' ' + QByteArray::number(range, 'f', 3);
            text += ' ' + line.odometry + ' ' + line.odometry + ' ' + stamp + " robot " + stamp + '\n';
        }
        return text;
    }
    /// True poses of the lines that count.
    std::vector<vectorlib::Pose2D> truth() const {
        std::vector<vectorlib::Pose2D> poses;
        for (const Line &line : lines)
            if (line.counts)
                poses.push_back(line.truth);
        return poses;
    }
};

/// The poses of a TUM file.
inline std::vector<vectorlib::Pose2D> posesOfTum(const QByteArray &text) {
    std::vector<vectorlib::Pose2D> poses;
    for (const QByteArray &line : text.split('\n')) {
        const QList<QByteArray> f = line.split(' ');
        if (f.size() == 8 && !line.startsWith('#'))
            poses.push_back(
                {f[1].toDouble(), f[2].toDouble(), 2 * std::atan2(f[6].toDouble(), f[7].toDouble())});
    }
    return poses;
}

/// The errors of motions between places that were met again, ten or more metres of way later, the largest
/// and the mean; metres.
struct RevisitErrors {
    double mean = 0, worst = 0;
    std::size_t pairs = 0;

    RevisitErrors(const std::vector<vectorlib::Pose2D> &found, const std::vector<vectorlib::Pose2D> &truth) {
        using vectorlib::Transformation2D;
        std::vector<double> way(1, 0.0);
        for (std::size_t i = 1; i < truth.size(); ++i)
            way.push_back(way.back() + std::hypot(truth[i].x - truth[i - 1].x, truth[i].y - truth[i - 1].y));
        for (std::size_t i = 0; i < truth.size() && truth.size() == found.size(); ++i)
            for (std::size_t j = 0; j < i && way[i] - way[j] > 10; ++j) {
                const Transformation2D real =
                    Transformation2D(truth[j]).inverse() * Transformation2D(truth[i]);
                if (real.translation().norm() > 1)
                    continue;
                const Transformation2D told =
                    Transformation2D(found[j]).inverse() * Transformation2D(found[i]);
                const double error = (real.inverse() * told).translation().norm();
                worst = std::max(worst, error);
                mean += error;
                ++pairs;
            }
        mean /= double(std::max<std::size_t>(1, pairs));
    }
};
