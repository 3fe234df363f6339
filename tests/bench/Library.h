#pragma once

#include <vectorlib/geometry/Vector2D.h>

#ifdef BENCH_BOOST
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#endif
#ifdef BENCH_OPENCV
#include <opencv2/imgproc.hpp>
#endif

#include <vector>

/// Line simplification of libraries, where they are installed. The points are converted outside of what is
/// measured: at the first call only.
namespace rivals {

#ifdef BENCH_BOOST
class BoostSimplify {
public:
    float tolerance = 0.06f;

    std::size_t operator()(vectorlib::PointSpan<float> points) {
        if (line_.size() != points.size())
            for (const auto &p : points)
                line_.emplace_back(p.x, p.y);
        simple_.clear();
        boost::geometry::simplify(line_, simple_, tolerance);
        return simple_.size() - 1;
    }

private:
    using Point = boost::geometry::model::d2::point_xy<float>;
    boost::geometry::model::linestring<Point> line_, simple_;
};
#endif

#ifdef BENCH_OPENCV
class OpenCvApprox {
public:
    float tolerance = 0.06f;

    std::size_t operator()(vectorlib::PointSpan<float> points) {
        if (line_.size() != points.size())
            for (const auto &p : points)
                line_.emplace_back(p.x, p.y);
        cv::approxPolyDP(line_, simple_, tolerance, false);
        return simple_.size() - 1;
    }

private:
    std::vector<cv::Point2f> line_, simple_;
};
#endif

} // namespace rivals
