#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Sector.h"

#include <vector>

namespace vectorlib {

/// The nearest edge in every direction around the origin, for edges that may touch and cross. The views of
/// two halves of the edges become one by a sweep over the angle that keeps the nearer; where both cross, it
/// changes from one to the other. O(n log n) for n edges, but for the crossings that are seen. Owns its
/// buffers.
class NearestEdges {
public:
    void clear();
    /// Adds an edge that does not run through the origin, between two directions. Of two edges in the same
    /// place the one that faces the origin is seen.
    void add(Vector2D<double> begin, Vector2D<double> end, bool facing, double lowest, double highest);
    /// The line of the edge that was added as number `edge`, from 0.
    const SightLine &line(std::size_t edge) const { return lines_[edge]; }

    /// What is seen, from right to left; valid until the next call.
    const std::vector<Sector> &operator()();

private:
    void clip(Sector &sector, double lowest, double highest) const;
    // Views number 0 and 1, 2 and 3 ... become one each.
    void mergeNeighbours();
    // The view of sectors [i, middle) and that of [middle, end).
    void merge(std::size_t i, std::size_t middle, std::size_t end);
    void emitNearest(Sector both, std::size_t a, std::size_t b);
    void emit(const Sector &sector);

    std::vector<SightLine> lines_;
    std::vector<char> facing_;
    std::vector<Sector> sectors_, merged_;           // views behind each other
    std::vector<std::size_t> starts_, mergedStarts_; // where each begins, and the end of the last
    std::size_t first_ = 0;                          // of the view that is being made
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/observation/NearestEdges.cpp")
