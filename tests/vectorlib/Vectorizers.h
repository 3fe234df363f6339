#pragma once

#include <vectorlib/observation/SimulatedScanner.h>
#include <vectorlib/vectorization/AftlsVectorizer.h>
#include <vectorlib/vectorization/DouglasPeuckerVectorizer.h>
#include <vectorlib/vectorization/FtlsVectorizer.h>
#include <vectorlib/vectorization/IncVectorizer.h>
#include <vectorlib/vectorization/ReumannWitkamVectorizer.h>
#include <vectorlib/vectorization/SplitAndMergeVectorizer.h>

/// One of the vectorizers behind a common call.
struct Algorithm {
    using Lines = std::vector<vectorlib::VectorizedLine>;
    using Points = std::vector<vectorlib::Vector2D<double>>;
    const char *name;
    Lines (*run)(const Points &points, const vectorlib::VectorizerSettings &settings);
};

template <typename Vectorizer>
Algorithm::Lines runVectorizer(const Algorithm::Points &points,
                               const vectorlib::VectorizerSettings &settings) {
    Vectorizer vectorize;
    static_cast<vectorlib::VectorizerSettings &>(vectorize.settings) = settings;
    return vectorize(points);
}

inline Algorithm::Lines runSimplex(const Algorithm::Points &points,
                                   const vectorlib::VectorizerSettings &settings) {
    vectorlib::AftlsVectorizer<double> vectorize;
    vectorize.settings = settings;
    vectorize.search = vectorlib::AftlsVectorizer<double>::Search::NelderMead;
    return vectorize(points);
}

inline const std::vector<Algorithm> algorithms = {
    {"tls", runVectorizer<vectorlib::TlsVectorizer<double>>},
    {"ftls", runVectorizer<vectorlib::FtlsVectorizer<double>>},
    {"aftls", runVectorizer<vectorlib::AftlsVectorizer<double>>},
    {"aftls by Nelder-Mead", runSimplex},
    {"inc", runVectorizer<vectorlib::IncVectorizer<double>>},
    {"dp", runVectorizer<vectorlib::DouglasPeuckerVectorizer<double>>},
    {"rw", runVectorizer<vectorlib::ReumannWitkamVectorizer<double>>},
    {"sam", runVectorizer<vectorlib::SplitAndMergeVectorizer<double>>},
};

/// Whether the algorithm of a data row is one of these.
inline bool isOneOf(const Algorithm &algorithm, const QStringList &names) {
    return names.contains(algorithm.name);
}

/// E of thesis (6.27).
inline double errorOf(const Algorithm::Lines &lines) {
    double squares = 0, count = 0;
    for (const vectorlib::VectorizedLine &line : lines) {
        squares += vectorlib::sumOfSquares(line.sums);
        count += line.sums.n;
    }
    return squares / count;
}

/// A closed room of 4 to 12 walls of random directions around the origin, free space on their left.
inline std::vector<vectorlib::LineSegment2D<double>> randomRoom(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    const int walls = 4 + static_cast<int>(9 * u(random));
    Algorithm::Points corners;
    for (int i = 0; i < walls; ++i) {
        const double angle = 2 * vectorlib::pi * (i + 0.7 * (u(random) - 0.5)) / walls;
        corners.push_back(vectorlib::Vector2D<double>(std::cos(angle), std::sin(angle)) *
                          (2 + 6 * u(random)));
    }
    std::vector<vectorlib::LineSegment2D<double>> room;
    for (std::size_t i = 0; i < corners.size(); ++i)
        room.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    return room;
}

/// A scan of a random room: one open cluster with 1 cm noise of the range.
inline Algorithm::Points roomScan(std::uint64_t seed, int rays) {
    vectorlib::SimulatedScanner<double> scanner(seed);
    scanner.rays = rays;
    return scanner(randomRoom(seed), {});
}
