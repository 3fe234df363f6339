#include "vectorlib/experiments/RegistrationExperiment.h"

#include "vectorlib/io/Number.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

namespace hermes::experiments {

namespace {

/// Adds up the registrations at one pose.
class Statistics {
public:
    void take(const std::vector<vectorlib::SegmentPair> &pairs, bool weighted) {
        vectorlib::LineSegmentRegistration registration;
        registration.stiffness = {1, 1};
        for (const vectorlib::SegmentPair &p : pairs)
            registration.add({p.fixed, p.moving, weighted ? p.weight : 1});
        ++r_.runs;
        r_.reliability += registration.reliability();
        r_.leastReliability = std::min(r_.leastReliability, registration.reliability());
        r_.reliabilities.push_back(registration.reliability());
        r_.pairs += registration.pairs();
        if (!registration.isSolvable()) {
            ++r_.unsolved;
            return;
        }
        const vectorlib::Transformation2D t = registration.transformation();
        const vectorlib::Ambiguity ambiguity = registration.ambiguity();
        r_.ambiguityXY += ambiguity.xy / registration.weight();
        r_.ambiguityAlpha += ambiguity.alpha / registration.weight();
        const Eigen::Vector3d error(t.x(), t.y(), t.alpha());
        r_.mean += error;
        r_.spread += error * error.transpose();
    }
    RegistrationStatistics result() const {
        RegistrationStatistics r = r_;
        r.reliability /= std::max(1, r.runs);
        r.pairs /= std::max(1, r.runs);
        const double n = std::max(1, r.runs - r.unsolved);
        for (double *sum : {&r.ambiguityXY, &r.ambiguityAlpha})
            *sum /= n;
        r.mean /= n;
        r.spread /= n;
        r.errorXY = r.spread(0, 0) + r.spread(1, 1);
        r.errorAlpha = r.spread(2, 2);
        r.spread -= r.mean * r.mean.transpose();
        return r;
    }

private:
    RegistrationStatistics r_;
};

// The square of a mean of n values with so much variance, less what chance alone makes of it.
double squareOfMean(double square, double variance, int n) {
    return std::max(0.0, square - variance / std::max(1, n - 1));
}

} // namespace

double RegistrationStatistics::biasXY() const {
    return squareOfMean(mean.head<2>().squaredNorm(), spread(0, 0) + spread(1, 1), runs - unsolved);
}
double RegistrationStatistics::biasAlpha() const {
    return squareOfMean(mean(2) * mean(2), spread(2, 2), runs - unsolved);
}

std::size_t stepsOf(const World &world, const RegistrationCase &which, const ExperimentOptions &options) {
    std::size_t points = 0;
    for (const int each : which.points)
        if (static_cast<std::size_t>(each) <= options.maxPoints)
            points += static_cast<std::size_t>(each);
    return points * world.poses.size() * which.sigmas.size();
}

std::vector<RegistrationRow> registrationExperiment(const World &world, const RegistrationCase &which,
                                                    const ExperimentOptions &options) {
    std::vector<RegistrationRow> rows;
    std::mt19937_64 random(options.seed);
    const std::size_t all = stepsOf(world, which, options);
    std::size_t done = 0;
    for (const int points : which.points)
        for (std::size_t pose = 0; pose < world.poses.size(); ++pose) {
            if (static_cast<std::size_t>(points) > options.maxPoints)
                continue;
            const KnownScan scan(world, world.poses[pose], points);
            for (const double sigma : which.sigmas) {
                Statistics plain, weighted;
                ScanPairs makePairs(which.pairing, sigma);
                for (int run = 0; run < options.runs; ++run) {
                    const auto &pairs = makePairs(scan, which.minLength, random);
                    plain.take(pairs, false);
                    weighted.take(pairs, true);
                }
                rows.push_back({world.name, pose, world.poses[pose], points, sigma, false, plain.result()});
                rows.push_back({world.name, pose, world.poses[pose], points, sigma, true, weighted.result()});
                done += static_cast<std::size_t>(points);
                if (options.progress)
                    options.progress(done, all);
            }
        }
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<RegistrationRow> &rows) {
    using vectorlib::Number;
    out << "world,pose,points,sigma,weighted,runs,unsolved,a_t,a_alpha,d_t,d_alpha,reliability,"
           "least_reliability,mean_x,mean_y,mean_alpha,var_x,var_y,cov_xy,var_alpha,pairs\n";
    for (const RegistrationRow &row : rows) {
        const RegistrationStatistics &r = row.result;
        out << row.world << ',' << row.pose << ',' << row.points << ',' << Number(row.sigma) << ','
            << row.weighted << ',' << r.runs << ',' << r.unsolved;
        for (const double value : {r.ambiguityXY, r.ambiguityAlpha, r.errorXY, r.errorAlpha, r.reliability,
                                   r.leastReliability, r.mean(0), r.mean(1), r.mean(2), r.spread(0, 0),
                                   r.spread(1, 1), r.spread(0, 1), r.spread(2, 2), r.pairs})
            out << ',' << Number(value);
        out << '\n';
    }
}

} // namespace hermes::experiments
