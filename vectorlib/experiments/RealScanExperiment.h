#pragma once

#include "vectorlib/experiments/Plot.h"
#include "vectorlib/experiments/RealScan.h"

#include <ostream>

namespace hermes::experiments {

/// What every algorithm makes of a scan, as the tables of thesis figures 6.11 to 6.13 show it.
struct RealScanResult {
    struct Row {
        std::string algorithm; ///< label
        std::size_t lines = 0;
        double microseconds = 0; ///< of the vectorization of all clusters
    };
    RealScan scan;
    /// The fewest that keep sigma, see fewestLines(). The thesis has those that a person counted.
    std::size_t linesReference = 0;
    std::vector<Row> rows; ///< FTLS first

    double linesPercent(const Row &row) const { return percent(double(row.lines), double(linesReference)); }
    /// Against FTLS.
    double timePercent(const Row &row) const { return percent(row.microseconds, rows[0].microseconds); }

private:
    static double percent(double value, double of) { return of > 0 ? 100 * (value / of - 1) : 0; }
};

RealScanResult realScanExperiment(const RealScan &scan);

void writeCsv(std::ostream &out, const RealScanResult &result);
/// The scan with the lines of FTLS.
vectorlib::SvgPicture pictureOf(const std::string &title, const RealScanResult &result);
/// As it is printed: points and lines, lines of each algorithm, their times.
Table tableOf(const std::string &title, const RealScanResult &result);

} // namespace hermes::experiments
