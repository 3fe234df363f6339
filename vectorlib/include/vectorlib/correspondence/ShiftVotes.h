#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/registration/ScanSurface.h"
#include "vectorlib/simd/LargestOfSixteen.h"

#include <array>
#include <cstdint>

namespace vectorlib {

/// A motion between two scans that many pairs of their pieces ask for.
struct MotionVote {
    Transformation2D pose; ///< of the moving scan in the frame of the fixed one
    float votes = 0;       ///< grows with the length of the surfaces that would come to lie together
};

/// Which translations bring the surfaces of a scan, turned by a given angle, onto those of another: every
/// pair of pieces that face the same way votes for the shift between them. It is an exhaustive correlation,
/// in a square of shifts about zero. Keeps its buffers.
class ShiftVotes {
public:
    float cell = 0.2f;       ///< of the square of shifts, at least; metres
    float tolerance = 15;    ///< most between the normals of pieces that vote; degrees
    std::size_t perTurn = 8; ///< strongest shifts kept for each rotation
    float share = 0.4f;      ///< of the votes of the strongest, with which others are kept

    /// Shifts of more than `reach` metres in x or y are not seen.
    void start(const ScanSurface &fixed, const ScanSurface &moving, float reach) {
        fixed_ = &fixed.pieces();
        moving_ = &moving.pieces();
        cell_ = std::max(cell, 2 * reach / cells);
        std::size_t k = 0;
        for (std::size_t degree = 0; degree < begins_.size(); ++degree) {
            while (k < fixed_->size() && (*fixed_)[k].direction < static_cast<float>(degree))
                ++k;
            begins_[degree] = k;
        }
    }
    /// Adds the strongest shifts after a turn to the list.
    void operator()(int degrees, std::vector<MotionVote> &list) {
        count(degrees);
        smooth();
        collectPeaks(degrees, list);
    }

private:
    static constexpr int cells = 96; // to a side
    static constexpr int block = 16, blocks = cells * cells / block;
    using Counts = std::vector<std::int16_t>;

    void count(int degrees) {
        counts_.assign(cells * cells, 0);
        const float angle = static_cast<float>(degrees * pi / 180), c = std::cos(angle), s = std::sin(angle);
        const float inverse = 1 / cell_;
        for (const SurfacePiece &piece : *moving_) {
            const Vector2D<float> p = piece.place;
            const Vector2D<float> zero(cells / 2 - (c * p.x - s * p.y) * inverse,
                                       cells / 2 - (s * p.x + c * p.y) * inverse);
            float from = piece.direction + static_cast<float>(degrees) - tolerance;
            from -= 360 * std::floor(from / 360);
            const float to = from + 2 * tolerance;
            const auto vote = [&](std::size_t k, float end) {
                for (; k < fixed_->size() && (*fixed_)[k].direction <= end; ++k)
                    add((*fixed_)[k].place * inverse + zero, weight(piece) * weight((*fixed_)[k]));
            };
            vote(begins_[std::min<std::size_t>(359, static_cast<std::size_t>(from))], to);
            if (to > 360)
                vote(0, to - 360);
        }
    }
    // In decimetres. A pair counts by the product of its lengths, so that sparse and dense points count
    // alike.
    static int weight(const SurfacePiece &piece) { return static_cast<int>(piece.length * 10 + 0.5f); }
    void add(Vector2D<float> at, int votes) {
        if (!(at.x >= 0 && at.y >= 0 && at.x < cells && at.y < cells))
            return;
        const int number = static_cast<int>(at.y) * cells + static_cast<int>(at.x);
        std::int16_t &sum = counts_[static_cast<std::size_t>(number)];
        sum = static_cast<std::int16_t>(std::min(sum + votes, 2047)); // sixteen of them are no overflow
    }
    // Sums over three by three cells, weighted 1 2 1 both ways.
    void smooth() {
        rows_.resize(cells * cells);
        smooth_.resize(cells * cells);
        const std::int16_t *from = counts_.data();
        std::int16_t *row = rows_.data(), *to = smooth_.data();
        for (int i = 1; i < cells * cells - 1; ++i)
            row[i] = static_cast<std::int16_t>(from[i - 1] + 2 * from[i] + from[i + 1]);
        for (int i = cells; i < cells * (cells - 1); ++i)
            to[i] = static_cast<std::int16_t>(row[i - cells] + 2 * row[i] + row[i + cells]);
        most_ = 0;
        for (int i = 0; i < blocks; ++i) {
            const std::int16_t most = simd::largestOfSixteen(to + i * block);
            mostOf_[static_cast<std::size_t>(i)] = most;
            most_ = std::max(most_, most);
        }
    }
    void collectPeaks(int degrees, std::vector<MotionVote> &list) {
        const std::size_t first = list.size();
        const auto weakest = [&] {
            return std::min_element(
                list.begin() + static_cast<std::ptrdiff_t>(first), list.end(),
                [](const MotionVote &a, const MotionVote &b) { return a.votes < b.votes; });
        };
        int least = static_cast<int>(share * most_);
        for (int i = 0; i < blocks; ++i) {
            if (mostOf_[static_cast<std::size_t>(i)] <= least)
                continue;
            for (int at = i * block; at < (i + 1) * block; ++at) {
                if (smooth_[static_cast<std::size_t>(at)] <= least || !isPeak(at))
                    continue;
                const MotionVote vote = voteAt(at, degrees);
                if (list.size() - first < perTurn)
                    list.push_back(vote);
                else
                    *weakest() = vote;
                if (list.size() - first == perTurn)
                    least = std::max(least, static_cast<int>(weakest()->votes));
            }
        }
    }
    bool isPeak(int at) const {
        const int x = at % cells, y = at / cells;
        if (x < 2 || x >= cells - 2 || y < 2 || y >= cells - 2)
            return false;
        const std::int16_t *p = smooth_.data() + at, v = *p;
        return v > p[-cells - 1] && v > p[-cells] && v > p[-cells + 1] && v > p[-1] && v >= p[1] &&
               v >= p[cells - 1] && v >= p[cells] && v >= p[cells + 1];
    }
    // The top of the parabolas through the cells beside the peak.
    MotionVote voteAt(int at, int degrees) const {
        const std::int16_t *p = smooth_.data() + at;
        const auto top = [&](int step) {
            const float before = p[-step], middle = p[0], after = p[step], bend = before - 2 * middle + after;
            return bend < 0 ? 0.5f * (before - after) / bend : 0.0f;
        };
        const float x = static_cast<float>(at % cells) + 0.5f - cells / 2 + top(1);
        const float y = static_cast<float>(at / cells) + 0.5f - cells / 2 + top(cells);
        return {Transformation2D(x * cell_, y * cell_, degrees * pi / 180), static_cast<float>(p[0])};
    }

    const std::vector<SurfacePiece> *fixed_ = nullptr, *moving_ = nullptr;
    std::array<std::size_t, 361> begins_{}; // of the fixed pieces, by whole degrees
    float cell_ = 0.2f;
    Counts counts_, rows_, smooth_;
    std::array<std::int16_t, blocks> mostOf_{}; // each sixteen cells
    std::int16_t most_ = 0;
};

} // namespace vectorlib
