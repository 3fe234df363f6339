#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanIndex.h"
#include "vectorlib/registration/WallDirections.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// A short piece of the surfaces that a scan saw; sensor frame, metres.
struct SurfacePiece {
    Vector2D<float> place;
    Vector2D<float> normal; ///< of unit length, towards the sensor's side
    float direction = 0;    ///< of the normal; degrees in [0, 360)
    float length = 0;       ///< how much of the surface it stands for; metres
};

/// The surfaces of a scan in even pieces, whatever the distance they were seen from. Points lie close
/// together on near walls and far apart on distant ones; how much of two scans agrees is told by lengths of
/// wall, not by numbers of points, as from another place other walls are near. Keeps its buffers between
/// scans.
class ScanSurface {
public:
    float spacing = 0.10f;       ///< least distance of neighbouring pieces; metres
    float longest = 0.30f;       ///< no point stands for more than so much of a surface; metres
    std::size_t maxPieces = 150; ///< of a scan with more, pieces lie farther apart

    /// Takes the surfaces of a scan.
    void build(const ScanIndex &scan);
    /// Sorted by the directions of their normals. Points that stand alone have none and are left out.
    const std::vector<SurfacePiece> &pieces() const { return pieces_; }
    /// How much of a surface the point of that number in the scan's index stands for; metres.
    float lengthOf(int point) const { return lengths_[static_cast<std::size_t>(point)]; }
    /// Of all points together; metres.
    float length() const { return total_; }
    /// Half of the points are nearer to the sensor; metres.
    float medianRange() const { return medianRange_; }

private:
    // A point stands for half of the way to each of its neighbours.
    void measureLengths(const ScanIndex &scan);
    void cut(const ScanIndex &scan, float least);

    std::vector<SurfacePiece> pieces_;
    std::vector<float> lengths_; // by point
    std::vector<float> squares_; // of the ranges
    float total_ = 0, medianRange_ = 0;
};

/// The pieces of a scan's surfaces by place: which one is nearest, for any place within reach of them, at the
/// cost of one look-up. A square grid of fixed size; its cells grow with the scan. Keeps its buffers between
/// scans.
class SurfaceGrid {
public:
    /// Places farther than `reach` from every piece have none; metres.
    void build(const std::vector<SurfacePiece> &pieces, float reach);
    /// The number of the piece that lies nearest, to a cell; -1 where none is within reach.
    int nearest(Vector2D<float> p) const;

private:
    static constexpr int cells = 128; // to a side
    static constexpr float least = 0.15f;

    void layOver(const std::vector<SurfacePiece> &pieces, float reach);

    Vector2D<float> corner_;
    float cell_ = least, inverse_ = 1 / least;
    std::vector<std::int16_t> nearest_;
    std::vector<float> squares_; // of the distances to the nearest
};

/// How much of the surfaces of two scans lies on each other, as lengths: a stretch of wall counts the same
/// whether it was seen by many points from nearby or by few from afar.
class SurfaceAgreement {
public:
    /// A scan's points and the lengths that they stand for.
    struct Scan {
        const ScanIndex &points;
        const ScanSurface &surface;
    };

    SurfaceAgreement() = default;
    /// Judges every n-th point of both scans when the moving one lies at the pose. A point `deviation` metres
    /// from the other scan's wall, along the normal, is explained to two thirds of its length.
    SurfaceAgreement(Scan fixed, Scan moving, const Transformation2D &pose, double deviation, int sample) {
        add(fixed, pose.inverse(), moving.points, deviation, sample);
        walls_.turn(pose); // from the moving frame to the fixed one
        add(moving, pose, fixed.points, deviation, sample);
    }
    /// Of all that was judged; metres.
    double length() const { return length_; }
    /// Share that has something of the other scan beside it.
    double explained() const { return length_ > 0 ? explained_ / length_ : 0; }
    /// Share at whose place the other scan saw through.
    double contradicted() const { return length_ > 0 ? contradicted_ / length_ : 0; }
    /// In [-1, 1]; 1 is perfect: explained less contradicted length, as a share of both and of half of what
    /// is out of the other scan's sight.
    double score() const { return balance(0.5); }
    /// The same with little weight, 0.15, on what is out of sight: the other scan says nothing of it. Two
    /// motions that fit alike what both scans could see are about equal, unless one hardly overlaps.
    double consistency() const { return balance(0.15); }
    /// How well what is explained fixes the motion, in the fixed frame: in the weakest direction the scans
    /// slide on each other most easily.
    const WallDirections &walls() const { return walls_; }

private:
    // What is out of sight weighs `hidden` of its length.
    double balance(double hidden) const {
        const double judged = explained_ + contradicted_, all = judged + hidden * (length_ - judged);
        return all > 0 ? (explained_ - contradicted_) / all : 0;
    }
    void add(Scan scan, const Transformation2D &motion, const ScanIndex &other, double deviation, int sample);

    double length_ = 0, explained_ = 0, contradicted_ = 0;
    WallDirections walls_;
};

/// Brings the surfaces of a scan onto those of another from half a metre and a few degrees away, roughly and
/// fast: a few Gauss-Newton steps on the distances of the moving pieces along the normals of those nearest to
/// them, while the gate narrows. Pieces pair only when they face the same way.
class SurfaceRefinement {
public:
    double gate = 0.6;       ///< the first; pieces farther apart along the normal hardly count; metres
    double lastGate = 0.15;  ///< metres
    double gateFactor = 0.6; ///< from step to step
    int steps = 4;
    double sameWay = 0.7; ///< cosine of the most between two normals

    /// Takes the surfaces of two scans, each in its sensor's frame; they must outlive the calls that follow.
    void start(const ScanSurface &fixed, const ScanSurface &moving) {
        fixed_ = &fixed.pieces();
        moving_ = &moving.pieces();
        grid_.build(*fixed_, static_cast<float>(gate));
    }
    /// The transformation of the moving scan onto the fixed one, from one nearby.
    Transformation2D operator()(Transformation2D pose) const;

private:
    Transformation2D improved(const Transformation2D &pose, double width) const;

    const std::vector<SurfacePiece> *fixed_ = nullptr, *moving_ = nullptr;
    SurfaceGrid grid_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/ScanSurface.cpp")
