// Our matchers of two scans of which nothing else is known, each from the points to the motion.
#pragma once

#include "tests/bench/PairRows.h"

#include <vectorlib/correspondence/CorrespondenceFinder.h>
#include <vectorlib/edges/EdgeExtractor.h>
#include <vectorlib/mapping/GlobalPairMatcher.h>
#include <vectorlib/relations/RelationMatcher.h>
#include <vectorlib/relations/TypedSegmentExtractor.h>

namespace bench {

struct ByGlobalPairMatcher {
    vectorlib::GlobalPairMatcher match;

    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        const vectorlib::GlobalPairMatch &found = match(pair.fixed, pair.moving);
        if (found.solutions.empty())
            return {};
        return {found.solutions[0].pose, found.isAccepted()};
    }
};

/// From scans of edges: the extraction is not timed.
struct ByRelationsOfEdges {
    vectorlib::TypedSegmentExtractor extract;
    vectorlib::RelationMatcher match;
    std::vector<vectorlib::TypedSegment> reference, current;

    void prepare(const ScanPair &pair) {
        extract.setScanner(pair.sweep(), pair.rays);
        reference = extract(pair.fixed);
        current = extract(pair.moving);
    }
    Answer operator()(const ScanPair &) {
        const vectorlib::RelationMatch &found = match(reference, current);
        return {found.pose, found.isMatched()};
    }
};

struct ByRelations {
    ByRelationsOfEdges match;

    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        match.prepare(pair);
        return match(pair);
    }
};

/// Any rotation, and shifts of up to 1.5 m each way.
struct ByFinderOfEdges {
    vectorlib::EdgeExtractor extract;
    vectorlib::CorrespondenceFinder find;
    std::vector<vectorlib::LineSegment2D<double>> fixed, moving;

    ByFinderOfEdges() { find.settings.permitted = {1.5, 1.5, vectorlib::pi}; }
    void prepare(const ScanPair &pair) {
        extract.segment.settings = vectorlib::EarSettings::forScanner(pair.fieldOfView, pair.rays);
        take(pair.fixed, fixed);
        take(pair.moving, moving);
    }
    void take(const Points &points, std::vector<vectorlib::LineSegment2D<double>> &segments) {
        segments.clear();
        for (const vectorlib::EdgeRaw2D &edge : extract(points))
            segments.push_back(edge.segment);
    }
    Answer operator()(const ScanPair &) {
        const vectorlib::SearchResult &found = find(fixed, moving);
        if (found.solutions.empty())
            return {};
        return {found.solutions[0].pose, found.solutions[0].accepted};
    }
};

struct ByFinder {
    ByFinderOfEdges match;

    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        match.prepare(pair);
        return match(pair);
    }
};

} // namespace bench
