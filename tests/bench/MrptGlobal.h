// What MRPT (libmrpt-slam-dev) has for two scans of which nothing else is known, each from the points to the
// motion. Settings that are not its own were chosen on other pairs than those that are measured.
#pragma once

#include "tests/bench/MrptIcp.h"

#include <vectorlib/relations/TypedSegmentExtractor.h>

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPosePDFSOG.h>
#include <mrpt/random.h>
#include <mrpt/slam/CGridMapAligner.h>
#include <mrpt/tfest/se2.h>

#include <iostream>
#include <limits>

namespace bench {

/// The mode of a sum of Gaussians that has most weight; nothing of an empty sum.
inline Answer maxLikely(const mrpt::poses::CPosePDFSOG &sum) {
    Answer answer;
    double most = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < sum.size(); ++i)
        if (sum[i].log_w > most) {
            most = sum[i].log_w;
            answer = {motionOf(sum[i].mean), true};
        }
    return answer;
}

/// CGridMapAligner: grid maps of both scans, corners of their pictures, modified RANSAC over pairs of corners
/// that look alike, then iterative closest points. Settings of MRPT's example of grid matching, but for more
/// corners (threshold of the detector 0.005 instead of 0.20: a map of one scan has few) and the least share
/// of corners that agree (0.20 instead of 0.15).
class MrptGridMaps {
public:
    MrptGridMaps() {
        mrpt::random::getRandomGenerator().randomize(1);
        options_.methodSelection = mrpt::slam::CGridMapAligner::amModifiedRANSAC;
        options_.featsPerSquareMeter = 0.012f;
        options_.threshold_max = 0.20f;
        options_.threshold_delta = 0.09f;
        options_.ransac_minSetSizeRatio = 0.20f;
        options_.ransac_chi2_quantile = 0.5;
        options_.feature_descriptor = mrpt::vision::descPolarImages;
        auto &detect = options_.feature_detector_options;
        detect.featsType = mrpt::vision::featHarris;
        detect.patchSize = 0;
        detect.harrisOptions.min_distance = 6;
        detect.harrisOptions.threshold = 0.005f;
        detect.PolarImagesOptions.bins_angle = 8;
        detect.PolarImagesOptions.bins_distance = 6;
        detect.PolarImagesOptions.radius = 20;
    }
    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        const Silence silence;
        const auto fixed = mapOf(pair.fixed, pair), moving = mapOf(pair.moving, pair);
        mrpt::slam::CGridMapAligner align; // one for each pair: it knows maps again by their addresses
        align.options = options_;
        align.setMinLoggingLevel(mrpt::system::LVL_ERROR);
        const auto found = align.Align(&fixed, &moving, mrpt::poses::CPose2D());
        return maxLikely(dynamic_cast<const mrpt::poses::CPosePDFSOG &>(*found));
    }

private:
    /// MRPT tells on std::cout where it finds fewer corners than it may.
    struct Silence {
        Silence() { std::cout.setstate(std::ios::failbit); }
        ~Silence() { std::cout.clear(); }
        Silence(const Silence &) = delete;
        Silence &operator=(const Silence &) = delete;
    };
    static constexpr float cell = 0.10f, reach = 40, half = 20; // metres; the grid grows where it must

    mrpt::maps::CMultiMetricMap mapOf(const Points &points, const ScanPair &pair) {
        auto grid = mrpt::maps::COccupancyGridMap2D::Create(-half, half, -half, half, cell);
        grid->insertionOptions.maxDistanceInsertion = reach;
        grid->insertionOptions.maxOccupancyUpdateCertainty = 0.60f;
        grid->insertionOptions.considerInvalidRangesAsFreeSpace = true;
        grid->insertObservation(scanOf(points, pair));
        auto cloud = mrpt::maps::CSimplePointsMap::Create();
        fill(*cloud, points);
        mrpt::maps::CMultiMetricMap map;
        map.maps.push_back(grid);
        map.maps.push_back(cloud);
        return map;
    }
    const mrpt::obs::CObservation2DRangeScan &scanOf(const Points &points, const ScanPair &pair) {
        const double first = -pair.fieldOfView / 2, step = pair.fieldOfView / double(pair.rays);
        scan_.aperture = float(pair.fieldOfView - step);
        scan_.maxRange = reach;
        scan_.resizeScanAndAssign(pair.rays, reach, false);
        for (const auto &p : points) {
            const double ray = std::round((std::atan2(p.y, p.x) - first) / step);
            const auto i = std::size_t(std::clamp(ray, 0.0, double(pair.rays - 1)));
            scan_.setScanRange(i, p.norm());
            scan_.setScanRangeValidity(i, true);
        }
        return scan_;
    }

    mrpt::slam::CGridMapAligner::TConfigParams options_;
    mrpt::obs::CObservation2DRangeScan scan_;
};

/// se2_l2_robust: RANSAC over pairs of landmarks that may be one, then iterative closest points. The
/// landmarks are our corners, since MRPT has none of scans; two may be one if kind and angle are alike.
class MrptLandmarks {
public:
    MrptLandmarks() { mrpt::random::getRandomGenerator().randomize(1); }
    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        takeCandidates(pair);
        mrpt::tfest::TSE2RobustParams settings;
        settings.ransac_maxSetSize = unsigned(candidates_.size()); // as MRPT recommends
        mrpt::tfest::TSE2RobustResult result;
        if (candidates_.size() < settings.ransac_minSetSize ||
            !mrpt::tfest::se2_l2_robust(candidates_, deviation, settings, result))
            return {};
        Answer answer = maxLikely(result.transformation);
        answer.motion = refine_.from(pair, answer.motion);
        return answer;
    }

private:
    static constexpr double deviation = 0.02; // of a landmark; metres
    static constexpr double window = 0.10;    // of the angle of a corner; radians

    void takeCandidates(const ScanPair &pair) {
        extract_.setScanner(pair.sweep(), pair.rays);
        findCorners_(extract_(pair.fixed), settings_, fixed_);
        findCorners_(extract_(pair.moving), settings_, moving_);
        candidates_.clear();
        for (std::size_t i = 0; i < fixed_.size(); ++i)
            for (std::size_t k = 0; k < moving_.size(); ++k)
                if (mayBeOne(fixed_[i], moving_[k]))
                    candidates_.emplace_back(unsigned(i), unsigned(k), float(fixed_[i].point.x),
                                             float(fixed_[i].point.y), 0.0f, float(moving_[k].point.x),
                                             float(moving_[k].point.y), 0.0f);
    }
    static bool mayBeOne(const vectorlib::Corner &a, const vectorlib::Corner &b) {
        const bool isJump = a.first < 0 || a.second < 0; // then the angle is that of a shadow
        return a.type == b.type && (isJump || std::abs(vectorlib::wrapAngle(a.angle - b.angle)) < window);
    }

    vectorlib::TypedSegmentExtractor extract_;
    vectorlib::CornerFinder findCorners_;
    vectorlib::RelationSettings settings_;
    std::vector<vectorlib::Corner> fixed_, moving_;
    mrpt::tfest::TMatchingPairList candidates_;
    MrptIcp<false> refine_;
};

} // namespace bench
