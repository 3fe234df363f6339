#include <vectorlib/registration/LineSegmentRegistration.h>
#include <vectorlib/similarity/EdgeSetComparator.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

using namespace vectorlib;

namespace {

constexpr std::size_t transformations = 256;

std::vector<SegmentPair> randomPairs(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> position(-5, 5);
    const auto point = [&] { return Vector2D<double>(position(random), position(random)); };
    std::vector<SegmentPair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const LineSegment2D<double> fixed(point(), point());
        pairs.push_back({fixed, Transformation2D(0.1, -0.2, 0.3) * fixed, 1});
    }
    return pairs;
}

std::vector<Transformation2D> randomTransformations() {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<Transformation2D> result;
    for (std::size_t i = 0; i < transformations; ++i)
        result.emplace_back(any(random), any(random), 3 * any(random));
    return result;
}

/// One item is one transformation; the criterion is summed so that nothing can be left out.
template <typename Criterion>
void evaluate(benchmark::State &state, const Criterion &criterion) {
    const std::vector<Transformation2D> all = randomTransformations();
    for (auto _ : state) {
        double sum = 0;
        for (const Transformation2D &t : all)
            sum += criterion(t);
        benchmark::DoNotOptimize(sum);
    }
    state.counters["items"] = transformations;
}

void criterion(benchmark::State &state) {
    EdgeSetComparator comparator;
    comparator.add(randomPairs(std::size_t(state.range(0))));
    evaluate(state, comparator);
}

/// (7.16) and (7.17) as they stand: moves the end points of every pair, then computes both areas.
void naive(benchmark::State &state) {
    struct Pair {
        Vector2D<double> a, b, c, d;
    };
    std::vector<Pair> pairs;
    for (const SegmentPair &p : randomPairs(std::size_t(state.range(0))))
        pairs.push_back({p.fixed.begin(), p.fixed.end(), p.moving.begin(), p.moving.end()});
    evaluate(state, [&](const Transformation2D &t) {
        double sum = 0;
        for (const Pair &p : pairs) {
            const Vector2D<double> c = t * p.c, d = t * p.d, x = p.b - p.a;
            const double parallelogram = x.cross(d - c), triangle = x.cross(p.b + c + d - 3.0 * p.a);
            sum += parallelogram * parallelogram + triangle * triangle;
        }
        return sum;
    });
}

void expansion(benchmark::State &state) {
    EdgeSetComparator comparator;
    comparator.add(randomPairs(std::size_t(state.range(0))));
    evaluate(state, [&](const Transformation2D &t) {
        const CriterionExpansion e = comparator.expansion(t);
        return e.value + e.gradient.sum() + e.hessian.sum();
    });
}

/// Adds pairs to a set; one item is one pair.
template <typename Set>
void addPairs(benchmark::State &state) {
    const std::vector<SegmentPair> pairs = randomPairs(std::size_t(state.range(0)));
    for (auto _ : state) {
        Set set;
        set.add(pairs);
        benchmark::DoNotOptimize(set);
    }
    state.counters["items"] = double(pairs.size());
}

/// From the sums to transformation, reliability and ambiguity.
void registration(benchmark::State &state) {
    LineSegmentRegistration sums;
    sums.add(randomPairs(std::size_t(state.range(0))));
    for (auto _ : state) {
        benchmark::DoNotOptimize(sums);
        Transformation2D t = sums.transformation();
        double quality = sums.reliability() + sums.ambiguity().total();
        benchmark::DoNotOptimize(t);
        benchmark::DoNotOptimize(quality);
    }
    state.counters["items"] = 1;
}

void mergeSums(benchmark::State &state) {
    LineSegmentRegistration sums;
    sums.add(randomPairs(std::size_t(state.range(0))));
    const LineSegmentRegistration other = sums;
    for (auto _ : state) {
        LineSegmentRegistration both = sums;
        both.add(other);
        benchmark::DoNotOptimize(both);
    }
    state.counters["items"] = 1;
}

} // namespace

int main(int argc, char **argv) {
    const auto sizes = [](const char *name, auto function) {
        benchmark::RegisterBenchmark(name, function)->Arg(10)->Arg(100)->Arg(1000);
    };
    sizes("criterion of a transformation", criterion);
    sizes("the same, pair by pair", naive);
    sizes("criterion, gradient and Hessian", expansion);
    sizes("adding a pair to the criterion", addPairs<EdgeSetComparator>);
    sizes("registration from sums", registration);
    sizes("adding a pair to a registration", addPairs<LineSegmentRegistration>);
    sizes("merging two registrations", mergeSums);
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
