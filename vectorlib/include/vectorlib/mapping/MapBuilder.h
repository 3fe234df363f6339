#pragma once

#include "vectorlib/correspondence/CorrespondenceFinder.h"
#include "vectorlib/mapping/Observation2D.h"
#include "vectorlib/mapping/VectorMap.h"

#include <chrono>

namespace vectorlib {

/// What happened to one scan, and how long each step took; milliseconds.
struct ScanReport {
    enum class Outcome {
        Matched, ///< the pose was found in the map (the first scan defines the map's frame)
        Lost,    ///< no acceptable match: the expected pose stands
        Skipped  ///< too few edges to say anything: the expected pose stands, the map is left alone
    };
    Outcome outcome = Outcome::Skipped;
    Pose2D pose; ///< of the sensor in the map's frame
    double segmentMs = 0, vectorizeMs = 0, matchMs = 0, mapMs = 0;
    double totalMs() const { return segmentMs + vectorizeMs + matchMs + mapMs; }
};

struct MapBuilderSettings {
    bool grow = true;         ///< false: only find the pose, leave the map as it is
    std::size_t minEdges = 2; ///< scans with fewer edges are skipped
    double mergeDistance =
        0.10; ///< a matched edge is merged when no farther from its map edge; metres, root mean square
    double newEdgeLength = 0.15; ///< shorter unmatched edges do not enter the map; metres
    int lostBeforeRestart = 3;   ///< after so many lost scans in a row the map goes on from the expected pose
};

/// Builds a vector map scan by scan: extract edges, predict, match, merge. Reads as the pipeline of thesis
/// figure 3.1.
class MapBuilder {
public:
    MapBuilderSettings settings;
    EdgeExtractor extract;
    CorrespondenceFinder find;
    VectorMap map;

    /// Takes a scan (sensor frame, in order of acquisition) and where the sensor is expected to be (map
    /// frame).
    const ScanReport &process(PointSpan<float> scan, const Pose2D &expected) {
        m_report = ScanReport();
        const auto t0 = Clock::now();
        const Segmentation &clusters = extract.segment(scan);
        const auto t1 = Clock::now();
        const std::vector<EdgeRaw2D> &edges = extract.vectorizeClusters(clusters, scan);
        const auto t2 = Clock::now();
        m_edges = &edges;
        locate(Transformation2D(expected));
        const auto t3 = Clock::now();
        updateMap();
        const auto t4 = Clock::now();
        m_report.segmentMs = milliseconds(t0, t1);
        m_report.vectorizeMs = milliseconds(t1, t2);
        m_report.matchMs = milliseconds(t2, t3);
        m_report.mapMs = milliseconds(t3, t4);
        return m_report;
    }

    const ScanReport &report() const { return m_report; }
    /// The match of the last scan; pairs refer to matchedNumbers() and edges().
    const Match &match() const { return m_match; }
    /// Map edges that the last scan was compared with, by index of the match's static set.
    const std::vector<int> &candidates() const { return m_numbers; }
    /// The edges of the last scan, sensor frame.
    const std::vector<EdgeRaw2D> &edges() const { return *m_edges; }

    void clear() {
        map.clear();
        m_lost = 0;
        m_match = Match();
        m_numbers.clear();
    }

private:
    using Clock = std::chrono::steady_clock;
    static double milliseconds(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double, std::milli>(to - from).count();
    }

    void locate(const Transformation2D &expected) {
        m_pose = expected;
        m_match = Match();
        m_numbers.clear();
        if (m_edges->size() < settings.minEdges)
            m_report.outcome = ScanReport::Outcome::Skipped;
        else if (map.isEmpty())
            m_report.outcome = settings.grow ? ScanReport::Outcome::Matched : ScanReport::Outcome::Lost;
        else {
            collectVisible(expected);
            m_match = find(m_static, *m_edges, expected);
            m_report.outcome = m_match.accepted ? ScanReport::Outcome::Matched : ScanReport::Outcome::Lost;
            if (m_match.accepted)
                m_pose = m_match.pose;
        }
        m_lost = m_report.outcome == ScanReport::Outcome::Lost ? m_lost + 1 : 0;
        m_report.pose = m_pose.pose();
    }
    // The part of the map that the scan can touch from any permitted pose.
    void collectVisible(const Transformation2D &expected) {
        double reach = 0;
        for (const EdgeRaw2D &e : *m_edges)
            reach = std::max({reach, e.segment.begin().squaredNorm(), e.segment.end().squaredNorm()});
        reach = std::sqrt(reach) + std::max(find.settings.permitted.dx, find.settings.permitted.dy);
        const Vector2D<double> centre = expected.translation(), half(reach, reach);
        m_static.clear();
        for (int number : map.near(centre - half, centre + half)) {
            m_numbers.push_back(number);
            m_static.push_back(map.slots()[static_cast<std::size_t>(number)].edge.segment);
        }
    }
    void updateMap() {
        if (!settings.grow || m_report.outcome == ScanReport::Outcome::Skipped ||
            (m_report.outcome == ScanReport::Outcome::Lost && m_lost < settings.lostBeforeRestart))
            return;
        m_partner.assign(m_edges->size(), -1);
        if (m_report.outcome == ScanReport::Outcome::Matched)
            for (const CorrespondencePair &p : m_match.pairs)
                m_partner[static_cast<std::size_t>(p.moving)] = m_numbers[static_cast<std::size_t>(p.fixed)];
        for (std::size_t i = 0; i < m_edges->size(); ++i) {
            const EdgeRaw2D seen = m_pose * (*m_edges)[i];
            int number = m_partner[i];
            if (number >= 0 &&
                mergeable(map.slots()[static_cast<std::size_t>(number)].edge.segment, seen.segment) &&
                map.merge(number, seen))
                map.consolidate(number);
            else if (seen.segment.length() >= settings.newEdgeLength) {
                number = map.add(seen);
                map.consolidate(number);
            }
        }
    }
    bool mergeable(const LineSegment2D<double> &known, const LineSegment2D<double> &seen) const {
        const double a = known.across(seen.begin()), b = known.across(seen.end());
        return (a * a + a * b + b * b) / 3 <= settings.mergeDistance * settings.mergeDistance;
    }

    const std::vector<EdgeRaw2D> *m_edges = nullptr;
    std::vector<LineSegment2D<double>> m_static;
    std::vector<int> m_numbers;
    std::vector<int> m_partner;
    Transformation2D m_pose;
    Match m_match;
    ScanReport m_report;
    int m_lost = 0;
};

} // namespace vectorlib
