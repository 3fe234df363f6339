#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/io/CarmenScan.h"

#include <ostream>
#include <string>
#include <vector>

namespace hermes::vector {

/// Which scan of a log an experiment shows, by the lines that FTLS finds in it.
enum class RealScanKind {
    EmptyRoom, ///< long lines in all directions: thesis figure 6.11
    Corridor,  ///< long lines in one direction: figure 6.12
    Laboratory ///< the most lines: figure 6.13
};

/// One scan of a log and what every algorithm makes of it, as the tables of figures 6.11 to 6.13 show it.
struct RealScanResult {
    struct Row {
        std::string algorithm; ///< label
        std::size_t lines = 0;
        double microseconds = 0; ///< of the vectorization of all clusters
    };
    std::size_t scan = 0;   ///< its number in the log, from 0
    std::size_t points = 0; ///< in clusters
    std::size_t clusters = 0;
    std::vector<Row> rows;
    std::vector<std::vector<vectorlib::Vector2D<float>>> clouds; ///< by cluster
    std::vector<vectorlib::LineSegment2D<double>> segments;      ///< of FTLS
};

/// Chooses the scan and vectorizes it, sigma 2 cm. Only scans with returns in clusters on half of their rays,
/// and at least ten, are looked at; of a log without one it is empty.
RealScanResult realScanExperiment(const std::vector<vectorlib::CarmenScan> &scans, RealScanKind kind);

void writeCsv(std::ostream &out, const RealScanResult &result);
/// The scan with the lines of FTLS.
void draw(std::ostream &svg, const std::string &title, const RealScanResult &result);
/// The same with the table, as a LaTeX document.
void writeLatex(std::ostream &out, const std::string &title, const RealScanResult &result);

} // namespace hermes::vector
