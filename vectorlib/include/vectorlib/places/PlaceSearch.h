#pragma once

#include "vectorlib/places/PlaceFit.h"
#include "vectorlib/places/PlaceIndex.h"
#include "vectorlib/places/PlaceScan.h"

#include <chrono>
#include <unordered_map>

namespace vectorlib {

struct Proposal {
    Transformation2D pose;
    int hits = 0;
};

class PlaceSearch {
public:
    PlaceScan scan;
    PlaceFitter fit;
    std::size_t cornerBudget = 0, slideBudget = 60000;
    std::size_t keep = 48;
    std::size_t keepFits = 16, keepFine = 6;
    std::size_t kept = 0, tried = 0, cornersTried = 0;
    int mostWalls = 2;
    double slideShare = 0.6, slideOver = 0.5, slideStep = 0.25;
    double times[4] = {};

    const std::vector<PlaceFit> &operator()(PlaceIndex &index, const std::vector<EdgeRaw2D> &edges,
                                            PointSpan<float> points) {
        const auto t0 = Clock::now();
        scan.take(edges, points);
        const auto t1 = Clock::now();
        propose(index);
        const auto t2 = Clock::now();
        refine(index);
        const auto t3 = Clock::now();
        const auto ms = [](auto a, auto b) { return std::chrono::duration<double, std::milli>(b - a).count(); };
        times[0] = ms(t0, t1);
        times[1] = ms(t1, t2);
        times[2] = ms(t2, t3);
        return fits_;
    }
    const std::vector<Proposal> &proposals() const { return proposals_; }

private:
    using Clock = std::chrono::steady_clock;
    using Vector = Vector2D<double>;

    struct Turned {
        Vector position;
        std::uint8_t bit;
    };

    static bool overlaps(const Corner::Side &scan, const Corner::Side &map) {
        const double common = std::min(scan.to, map.to) - std::max(scan.from, map.from);
        return common >= 0.3 * scan.length();
    }
    void propose(PlaceIndex &index) {
        order();
        cells_.clear();
        tried = kept = 0;
        std::size_t used = 0;
        for (const Corner &s : scan.corners()) {
            if (tried >= cornerBudget)
                break;
            ++used;
            index.forEachCorner(s.turn, 0.12, [&](const Corner &m) {
                if (!overlaps(s.first, m.first) || !overlaps(s.second, m.second))
                    return;
                ++tried;
                const Transformation2D pose = poseOf(s, m);
                turnTo(pose.cos(), pose.sin());
                consider(index, pose.translation());
            });
        }
        cornersTried = tried;
        int walls = 0;
        for (const LineSegment2D<double> &w : scan.walls()) {
            if (tried - cornersTried > slideBudget || walls++ >= mostWalls)
                break;
            slide(index, w);
        }
        proposals_.clear();
        for (const auto &[key, p] : cells_)
            proposals_.push_back(p);
        const auto better = [](const Proposal &a, const Proposal &b) {
            return a.hits != b.hits ? a.hits > b.hits : a.pose.x() < b.pose.x();
        };
        const std::size_t n = std::min(keep, proposals_.size());
        std::partial_sort(proposals_.begin(), proposals_.begin() + std::ptrdiff_t(n), proposals_.end(), better);
        proposals_.resize(n);
    }
    // All places of a wall of the scan on walls of the map that are not much shorter.
    void slide(PlaceIndex &index, const LineSegment2D<double> &w) {
        index.forEachWall(slideShare * w.length(), [&](const LineSegment2D<double> &m) {
            const double alpha = std::atan2(w.direction().cross(m.direction()), w.direction().dot(m.direction()));
            const Transformation2D rotation(0, 0, alpha);
            const Vector middle = rotation.rotate(w.middle());
            turnTo(rotation.cos(), rotation.sin());
            // As far as most of it lies on the other.
            const double room = std::max(0.25 * std::min(m.length(), w.length()), 0.5 * std::abs(m.length() - w.length()) + slideOver);
            const double steps = std::ceil(2 * room / slideStep);
            for (double k = 0; k <= steps; ++k) {
                const Vector at = m.middle() + m.direction() * (room * (2 * k / steps - 1)) - middle;
                ++tried;
                consider(index, at);
            }
        });
    }
    static Transformation2D poseOf(const Corner &s, const Corner &m) {
        const auto turn = [](const Corner::Side &a, const Corner::Side &b) {
            return std::atan2(a.direction.cross(b.direction), a.direction.dot(b.direction));
        };
        const double one = turn(s.first, m.first), more = wrapAngle(turn(s.second, m.second) - one);
        const double a = std::min(s.first.length(), m.first.length()), b = std::min(s.second.length(), m.second.length());
        const double share = b * b / (a * a + b * b);
        const Transformation2D rotation(0, 0, one + share * more);
        const Vector t = m.position - rotation.rotate(s.position);
        return {t.x, t.y, rotation.alpha()};
    }
    // A few points from all over the scan first.
    void order() {
        few_.clear();
        const std::size_t n = scan.points().size(), count = std::min<std::size_t>(64, n);
        if (n == 0)
            return;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t part = (k * 27) % 64; // golden
            if (part < count)
                few_.push_back(scan.points()[part * n / count]);
        }
        if (count < 64)
            few_ = scan.points();
    }
    // The few points turned so, as far as they are needed.
    void turnTo(double cos, double sin) {
        cos_ = cos;
        sin_ = sin;
        turned_.clear();
    }
    const Turned &turned(std::size_t i) {
        while (turned_.size() <= i) {
            const WallPoint &p = few_[turned_.size()];
            const auto turn = [this](Vector2D<float> v) {
                return Vector(cos_ * double(v.x) - sin_ * double(v.y), sin_ * double(v.x) + cos_ * double(v.y));
            };
            turned_.push_back({turn(p.position), facingBit(turn(p.direction))});
        }
        return turned_[i];
    }
    void consider(PlaceIndex &index, Vector at) {
        WallTiles &tiles = index.tiles();
        const std::size_t n = few_.size();
        int hits = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Turned &p = turned(i);
            hits += tiles.shows(at + p.position, p.bit);
            if ((i == 7 && hits < 2) || (i == 15 && hits < 6) || (i == 31 && hits < 14))
                return;
        }
        hits = hits * 64 / std::max(1, int(n));
        ++kept;
        const double alpha = std::atan2(sin_, cos_);
        const auto key = std::int64_t(std::floor(at.x / 0.5)) * 1000003 + std::int64_t(std::floor(at.y / 0.5)) * 1009 +
                         std::int64_t(std::floor((alpha + pi) / (pi / 12)));
        Proposal &p = cells_[key];
        if (hits > p.hits)
            p = {Transformation2D(at.x, at.y, alpha), hits};
    }
    void refine(PlaceIndex &index) {
        const WallTiles &tiles = index.tiles();
        const std::vector<WallPoint> &points = scan.points();
        const auto every = [&](std::size_t n) { return std::max(1, int(points.size() / n)); };
        fits_.clear();
        for (const Proposal &p : proposals_)
            take(fit.judge(tiles, points, fit.refine(tiles, points, p.pose, every(32), 4, 0.35), every(32), false));
        std::sort(fits_.begin(), fits_.end(), better);
        if (fits_.size() > keepFits)
            fits_.resize(keepFits);
        rough_.swap(fits_);
        fits_.clear();
        for (PlaceFit &f : rough_)
            take(fit.judge(tiles, points, fit.refine(tiles, points, f.pose, every(80), 5, 0.25), every(80)));
        std::sort(fits_.begin(), fits_.end(), better);
        if (fits_.size() > keepFine)
            fits_.resize(keepFine);
        for (PlaceFit &f : fits_)
            f = fit.judge(tiles, points, fit.refine(tiles, points, f.pose, 1, 5, 0.2));
        std::sort(fits_.begin(), fits_.end(), better);
    }
    void take(const PlaceFit &f) {
        for (PlaceFit &other : fits_) {
            const Transformation2D way = other.pose.inverse() * f.pose;
            if (way.translation().norm() < 0.5 && std::abs(way.alpha()) < 0.17) {
                if (f.score() > other.score())
                    other = f;
                return;
            }
        }
        fits_.push_back(f);
    }
    static bool better(const PlaceFit &a, const PlaceFit &b) { return a.score() > b.score(); }

    double cos_ = 1, sin_ = 0;
    std::vector<Turned> turned_;
    std::vector<WallPoint> few_;
    std::unordered_map<std::int64_t, Proposal> cells_;
    std::vector<Proposal> proposals_;
    std::vector<PlaceFit> fits_, rough_;
};

} // namespace vectorlib
