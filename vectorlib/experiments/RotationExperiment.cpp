#include "vectorlib/experiments/RotationExperiment.h"

#include "vectorlib/io/Number.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <random>

namespace hermes::experiments {

std::vector<RotationRow> rotationExperiment(const ExperimentOptions &options) {
    constexpr int levels = 36, exactPairs = 2, setsPerRun = 50;
    const vectorlib::LineSegment2D<double> line({0, 0}, {1, 0});
    std::mt19937_64 random(options.seed);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<RotationRow> rows;
    for (int level = 1; level <= levels; ++level) {
        RotationRow row{vectorlib::pi * level / levels, 0, 0};
        const int sets = setsPerRun * options.runs;
        for (int set = 0; set < sets; ++set) {
            vectorlib::LineSegmentRegistration registration;
            for (int i = 0; i < exactPairs; ++i)
                registration.add(line, line);
            registration.add(line, vectorlib::Transformation2D(0, 0, row.noise * any(random)) * line);
            const auto squared = [&](vectorlib::Rotation rotation) {
                registration.rotation = rotation;
                const double alpha = registration.transformation().alpha();
                return alpha * alpha / sets;
            };
            row.mitsuta += squared(vectorlib::Rotation::Mitsuta);
            row.wahba += squared(vectorlib::Rotation::Wahba);
        }
        row.mitsuta = std::sqrt(row.mitsuta);
        row.wahba = std::sqrt(row.wahba);
        rows.push_back(row);
        if (options.progress)
            options.progress(static_cast<std::size_t>(level), levels);
    }
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<RotationRow> &rows) {
    using vectorlib::Number;
    out << "noise_rad,mitsuta_rad,wahba_rad\n";
    for (const RotationRow &row : rows)
        out << Number(row.noise) << ',' << Number(row.mitsuta) << ',' << Number(row.wahba) << '\n';
}

Plot plotOf(const std::vector<RotationRow> &rows) {
    Curve mitsuta{"Mitsuta", "#009e73", {}}, wahba{"Wahba", "#1b2a41", {}};
    for (const RotationRow &row : rows) {
        mitsuta.points.emplace_back(row.noise, row.mitsuta);
        wahba.points.emplace_back(row.noise, row.wahba);
    }
    return {"deviation",
            "mean rotation of three pairs, one of them turned at random",
            "largest turn [rad]",
            "standard deviation of the mean [rad]",
            false,
            false,
            {mitsuta, wahba}};
}

} // namespace hermes::experiments
