#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/places/ScanObjects.h"

#include <array>
#include <numeric>
#include <optional>

namespace vectorlib {

/// How a scan lies in a map at some pose.
struct PlaceFit {
    static constexpr double mostHiddenLead = 0.0125; ///< of a lead, by what walls hide
    Transformation2D pose;                           ///< of the sensor in the map's frame
    double points = 0;                               ///< that were compared
    double explained = 0;   ///< of them, with a wall of the map beside them that faces alike
    double distances = 0;   ///< sum of their squared distances from it; m^2
    double hidden = 0;      ///< explained points that another wall of the map hides
    double blocked = 0;     ///< other points that a wall of the map hides
    double discrepancy = 0; ///< area seen behind walls of the map; m^2
    /// What each object of the scan says for the place, and last what walls of the map hide; in points.
    std::array<double, ScanObjects::most + 1> said{};
    Eigen::Matrix3d information =
        Eigen::Matrix3d::Zero(); ///< of x, y, alpha by the explained points; 1/m^2 apart

    double explainedShare() const { return points > 0 ? explained / points : 0; }
    double hiddenShare() const { return points > 0 ? (hidden + blocked) / points : 0; }
    /// Up to 1: the explained share, less what lies apart and what is seen through walls.
    double score() const { return points > 0 ? std::accumulate(said.begin(), said.end(), 0.0) / points : 0; }
    /// How much higher the score is than that of another place of the same scan, when the object that speaks
    /// most for this one is not heard, and what walls hide little: an object that was moved onto one of the
    /// other place explains points, and can be looked through where it stood. Against a place that is not
    /// there when the other has no points.
    double leadOver(const PlaceFit &other) const;
    /// Mean squared distance of the explained points; m^2.
    double meanSquare() const { return explained > 0 ? distances / explained : 0; }
    /// In [0, 1], of the walls' directions as that of lines (paper (28)): small along a corridor.
    double reliability() const;
    /// Of x, y (metres) and alpha (radians). Points beside each other err alike, so that four count as one,
    /// and the map's own walls are known to 2 cm at best. Nothing where the walls do not fix the pose.
    std::optional<Eigen::Matrix3d> covariance() const;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/PlaceFit.cpp")
