#pragma once

#include "tests/bench/PairRows.h"

#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

namespace bench {

/// SampleConsensusPrerejective of PCL (libpcl-dev) with fast point feature histograms, from the points to the
/// motion; then iterative closest points. Its features are made of normals of surfaces, which a scan in a
/// plane does not have: five copies of the scan above each other make walls. Samples, similarity and share of
/// inliers are those of PCL's tutorial of robust alignment; the others were chosen on other pairs.
class PclPrerejective {
public:
    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        const Cloud::Ptr fixed = wallsOf(pair.fixed), moving = wallsOf(pair.moving);
        pcl::SampleConsensusPrerejective<pcl::PointXYZ, pcl::PointXYZ, Feature> align;
        align.setInputSource(moving);
        align.setSourceFeatures(featuresOf(moving));
        align.setInputTarget(fixed);
        align.setTargetFeatures(featuresOf(fixed));
        align.setMaximumIterations(5000);
        align.setNumberOfSamples(3);
        align.setCorrespondenceRandomness(10);
        align.setSimilarityThreshold(0.9f);
        align.setMaxCorrespondenceDistance(0.12); // metres
        align.setInlierFraction(0.25f);
        Cloud aligned;
        align.align(aligned);
        if (!align.hasConverged())
            return {};
        return {refined(fixed, moving, align.getFinalTransformation()), true};
    }

private:
    using Cloud = pcl::PointCloud<pcl::PointXYZ>;
    using Feature = pcl::FPFHSignature33;

    static Cloud::Ptr wallsOf(const Points &points) {
        constexpr float spacing = 0.08f, layer = 0.10f; // metres
        Cloud::Ptr cloud(new Cloud);
        Points::value_type last(1e9f, 1e9f);
        for (const auto &p : points) {
            if ((p - last).norm() < spacing)
                continue;
            last = p;
            for (int k = 0; k < 5; ++k)
                cloud->push_back({p.x, p.y, layer * float(k)});
        }
        return cloud;
    }
    static pcl::PointCloud<Feature>::Ptr featuresOf(const Cloud::Ptr &cloud) {
        pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
        pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> findNormals;
        findNormals.setInputCloud(cloud);
        findNormals.setRadiusSearch(0.25); // metres
        findNormals.compute(*normals);
        pcl::PointCloud<Feature>::Ptr features(new pcl::PointCloud<Feature>);
        pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, Feature> findFeatures;
        findFeatures.setInputCloud(cloud);
        findFeatures.setInputNormals(normals);
        findFeatures.setRadiusSearch(0.8); // metres
        findFeatures.compute(*features);
        return features;
    }
    static vectorlib::Transformation2D refined(const Cloud::Ptr &fixed, const Cloud::Ptr &moving,
                                               const Eigen::Matrix4f &start) {
        pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> refine;
        refine.setInputSource(moving);
        refine.setInputTarget(fixed);
        refine.setMaxCorrespondenceDistance(0.3); // metres
        refine.setMaximumIterations(30);
        Cloud aligned;
        refine.align(aligned, start);
        const Eigen::Matrix4f &m = refine.getFinalTransformation();
        return {m(0, 3), m(1, 3), std::atan2(double(m(1, 0)), double(m(0, 0)))};
    }
};

} // namespace bench
