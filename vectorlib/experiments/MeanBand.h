#pragma once

#include <cmath>
#include <vector>

namespace hermes::experiments {

/// The mean of several runs, and the bounds between which the mean of endlessly many lies with 95 %
/// (Student's distribution). Of a single run both are that run.
struct MeanBand {
    double mean = 0, low = 0, high = 0;

    static MeanBand of(const std::vector<double> &runs) {
        const double n = static_cast<double>(runs.size());
        double mean = 0, squares = 0;
        for (const double run : runs)
            mean += run;
        mean /= n; // of whole numbers the sum is exact
        for (const double run : runs)
            squares += (run - mean) * (run - mean);
        if (runs.size() < 2)
            return {mean, mean, mean};
        const double half = quantile(n - 1) * std::sqrt(squares / (n - 1) / n);
        return {mean, mean - half, mean + half};
    }

private:
    // The 97.5 % quantile: exact to 3 degrees of freedom, then by its expansion in 1 / freedom (Abramowitz
    // and Stegun 26.7.5), which is 0.3 % too small for 4 and right to 1e-4 for 20.
    static double quantile(double freedom) {
        if (freedom <= 3)
            return freedom <= 1 ? 12.7062 : freedom <= 2 ? 4.3027 : 3.1824;
        constexpr double z = 1.959964, z2 = z * z;
        const double first = z * (z2 + 1) / 4, second = z * ((5 * z2 + 16) * z2 + 3) / 96,
                     third = z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
        return z + (first + (second + third / freedom) / freedom) / freedom;
    }
};

} // namespace hermes::experiments
