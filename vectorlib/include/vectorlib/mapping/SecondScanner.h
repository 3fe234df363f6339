#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CorrespondenceTracker.h"
#include "vectorlib/edges/EdgeExtractor.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/TimedScan.h"

#include <limits>
#include <optional>
#include <vector>

namespace vectorlib {

/// A second scanner on the robot. Its scans are brought to the moment and into the frame of the first one's.
/// The edges of each of the two are matched with the map alone: the second one is believed only after the two
/// agreed at several places, and as long as they do; each time that it failed since, after more places. Keeps
/// its buffers between scans.
class SecondScanner {
public:
    enum class State {
        OnTrial,     ///< it was not yet compared at enough places
        Taken,       ///< its edges count as those of the first
        Contradicted ///< it shows another map, or from elsewhere than its mount tells, or its times cannot be
    };
    static constexpr int enoughPlaces = 3;
    static constexpr double apart_m = 0.1, apart_rad = 0.1; ///< of places at which it is compared
    static constexpr double most_m = 0.06, most_rad = 0.03; ///< by which it may be mounted otherwise

    /// Poses of both on the robot. Other ones begin the trial again.
    void setMounts(const Pose2D &first, const Pose2D &second);
    /// A scan of it comes, later than the one before.
    void begin(const SecondScan &scan);
    /// That scan, as it had been taken at the time `stamp` (seconds), while the first scanner moves at that
    /// velocity; again for another velocity. Settings of segments are those of the first.
    void bring(const SecondScan &scan, double stamp, const Twist2D &twist, const EdgeExtractor &first);
    /// Whether the match of both shows nearly all of its edges in the map: it has nothing to draw.
    bool isShown(const MapBuilder &builder) const;
    /// Compares it with the scan that the builder has just matched. `contradicted`: by the map, as of
    /// PlaceFit. False: this scan of it is not to be used.
    bool agrees(const MapBuilder &builder, double contradicted);
    /// The map was made anew: what was in it lies elsewhere.
    void move(const Transformation2D &moved);

    State state() const { return state_; }
    bool isTaken() const { return state_ == State::Taken; }
    /// In the frame of the first scanner.
    const Transformation2D &mount() const { return mount_; }
    /// Where it seems to be on the robot by what it sees; nothing before it was compared.
    std::optional<Pose2D> fitting() const {
        return compared_ > 0 ? std::optional(first_ * mount_.pose() * off_) : std::nullopt;
    }
    /// Of the last scan: points in its own frame, edges in that of the first scanner.
    const std::vector<Vector2D<float>> &points() const { return points_; }
    const std::vector<EdgeRaw2D> &edges() const { return edges_; }

private:
    static constexpr double nearlyAll = 0.9;                   // of the length of its edges
    static constexpr double maxContradicted = 0.3;             // of a scan that agrees
    static constexpr double wild_m = 0.2, wild_rad = 0.1;      // off, of one scan
    static constexpr double leastShare = 0.2;                  // by which the mean follows a scan
    static constexpr double longestTurn = 1.5, mostSwept = 5;  // of the time since its scan before
    static constexpr double openReliability = 0.1;             // below it walls leave a direction open
    static constexpr int badScan = 5, enoughBad = 3 * badScan; // a scan that agrees takes one of it back

    struct Compared {
        std::optional<Pose2D> off; // where the second scanner is by what both see, as of its mount
        bool isOpen = false;       // walls leave a direction open
        bool byFirst = false;      // the map shows the first one's edges
    };
    Compared compare(const MapBuilder &builder);
    // Takes it into the mean. False: it strays from that, or is far from its mount; the mean takes no stray
    // alone.
    bool follow(const Compared &compared);
    void takePlace(const Transformation2D &place, bool isOpen);
    bool refuse();

    Pose2D first_;
    Transformation2D mount_;
    EdgeExtractor extract_;
    CorrespondenceTracker track_;
    std::vector<Vector2D<float>> points_;
    std::vector<float> seconds_;
    std::vector<EdgeRaw2D> edges_, firstEdges_;
    State state_ = State::OnTrial;
    double begin_ = -std::numeric_limits<double>::infinity(); // of the last scan
    bool isPlausible_ = true;                                 // no longer than a turn and a half, in order
    Pose2D off_, last_;                                       // mean, and of the last one that was compared
    int bad_ = 0;
    int compared_ = 0, closed_ = 0; // scans, and of them those where walls leave no direction open
    int places_ = 0;
    int failures_ = 0; // times that it was taken before
    std::optional<Transformation2D> lastPlace_;
    std::vector<LineSegment2D<double>> placeEdges_; // that it saw there
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/SecondScanner.cpp")
