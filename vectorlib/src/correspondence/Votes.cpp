#include "vectorlib/correspondence/Votes.h"
#include "vectorlib/simd/Lanes.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY void RotationVotes::add(double alpha, double weight) {
    const int i = static_cast<int>(std::lround(alpha / bin)) + half_;
    if (i > 0 && i + 1 < static_cast<int>(votes_.size())) {
        votes_[static_cast<std::size_t>(i - 1)] += weight;
        votes_[static_cast<std::size_t>(i)] += 2 * weight;
        votes_[static_cast<std::size_t>(i + 1)] += weight;
    }
}

VECTORLIB_BODY const std::vector<double> &RotationVotes::peaks(int count) {
    peaks_.clear();
    for (int k = 0; k < count; ++k) {
        const auto top = std::max_element(votes_.begin(), votes_.end());
        if (top == votes_.end() || *top <= 0)
            break;
        const auto i = top - votes_.begin(), last = static_cast<std::ptrdiff_t>(votes_.size()) - 1;
        peaks_.push_back(static_cast<double>(i - half_) * bin);
        for (auto j = std::max<std::ptrdiff_t>(0, i - 2); j <= std::min(last, i + 2); ++j)
            votes_[static_cast<std::size_t>(j)] = 0;
    }
    return peaks_;
}

VECTORLIB_BODY const std::vector<TurnVote> &
TurnVotes::operator()(const ScanSurface &fixed, const ScanSurface &moving, std::size_t count) {
    fill(fixed, fixed_);
    fill(moving, moving_);
    std::copy_n(fixed_.begin(), turn, fixed_.begin() + turn);
    votes_.fill(0);
    for (std::size_t i = 0; i < turn; ++i)
        if (const float weight = moving_[i]; weight > 0)
            for (std::size_t r = 0; r < turn; ++r)
                votes_[r] += weight * fixed_[i + r];
    peaks_.clear();
    for (std::size_t r = 0; r < turn; ++r)
        if (isPeak(r))
            peaks_.push_back({static_cast<int>(r), votes_[r]});
    std::sort(peaks_.begin(), peaks_.end(), [](const TurnVote &a, const TurnVote &b) {
        return a.votes != b.votes ? a.votes > b.votes : a.degrees < b.degrees;
    });
    if (peaks_.size() > count)
        peaks_.resize(count);
    return peaks_;
}

template <typename Histogram>
void TurnVotes::fill(const ScanSurface &surface, Histogram &histogram) {
    histogram.fill(0);
    constexpr std::array<float, 5> spread{1, 2, 3, 2, 1};
    for (const SurfacePiece &piece : surface.pieces())
        for (std::size_t k = 0; k < spread.size(); ++k)
            histogram[(static_cast<std::size_t>(piece.direction) + turn + k - 2) % turn] +=
                spread[k] * piece.length;
}

VECTORLIB_BODY bool TurnVotes::isPeak(std::size_t r) const {
    if (!(votes_[r] > 0))
        return false;
    for (std::size_t d = 1; d <= 3; ++d) {
        const float after = votes_[(r + d) % turn], before = votes_[(r + turn - d) % turn];
        if (after > votes_[r] || before >= votes_[r])
            return false;
    }
    return true;
}

VECTORLIB_BODY void ShiftVotes::start(const ScanSurface &fixed, const ScanSurface &moving, float reach) {
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

VECTORLIB_BODY void ShiftVotes::count(int degrees) {
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

VECTORLIB_BODY void ShiftVotes::add(Vector2D<float> at, int votes) {
    if (!(at.x >= 0 && at.y >= 0 && at.x < cells && at.y < cells))
        return;
    const int number = static_cast<int>(at.y) * cells + static_cast<int>(at.x);
    std::int16_t &sum = counts_[static_cast<std::size_t>(number)];
    sum = static_cast<std::int16_t>(std::min(sum + votes, 2047)); // sixteen of them are no overflow
}

VECTORLIB_BODY void ShiftVotes::smooth() {
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
        maxOf_[static_cast<std::size_t>(i)] = most;
        most_ = std::max(most_, most);
    }
}

VECTORLIB_BODY void ShiftVotes::collectPeaks(int degrees, std::vector<MotionVote> &list) {
    const std::size_t first = list.size();
    const auto weakest = [&] {
        return std::min_element(list.begin() + static_cast<std::ptrdiff_t>(first), list.end(),
                                [](const MotionVote &a, const MotionVote &b) { return a.votes < b.votes; });
    };
    int least = static_cast<int>(share * most_);
    for (int i = 0; i < blocks; ++i) {
        if (maxOf_[static_cast<std::size_t>(i)] <= least)
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

VECTORLIB_BODY bool ShiftVotes::isPeak(int at) const {
    const int x = at % cells, y = at / cells;
    if (x < 2 || x >= cells - 2 || y < 2 || y >= cells - 2)
        return false;
    const std::int16_t *p = smooth_.data() + at, v = *p;
    return v > p[-cells - 1] && v > p[-cells] && v > p[-cells + 1] && v > p[-1] && v >= p[1] &&
           v >= p[cells - 1] && v >= p[cells] && v >= p[cells + 1];
}

VECTORLIB_BODY MotionVote ShiftVotes::voteAt(int at, int degrees) const {
    const std::int16_t *p = smooth_.data() + at;
    const auto top = [&](int step) {
        const float before = p[-step], middle = p[0], after = p[step], bend = before - 2 * middle + after;
        return bend < 0 ? 0.5f * (before - after) / bend : 0.0f;
    };
    const float x = static_cast<float>(at % cells) + 0.5f - cells / 2 + top(1);
    const float y = static_cast<float>(at / cells) + 0.5f - cells / 2 + top(cells);
    return {Transformation2D(x * cell_, y * cell_, degrees * pi / 180), static_cast<float>(p[0])};
}

} // namespace vectorlib
