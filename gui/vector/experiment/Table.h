#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace hermes {

/// One result: an algorithm on so many points.
struct ResultRow {
    double sigma = 0;        ///< permitted standard deviation of points from a line; metres
    std::size_t points = 0;  ///< rays of the scanner, or points of the cluster
    std::string algorithm;   ///< label
    int runs = 0;            ///< scans, each with noise of its own
    double linesTrue = 0;    ///< 0 where there is no true number
    double linesFound = 0;   ///< mean
    double area = 0;         ///< mean error area; m^2
    double microseconds = 0; ///< median time of a scan, vectorization alone

    double linesPercent() const { return linesTrue > 0 ? 100 * (linesFound / linesTrue - 1) : 0; }
};

/// A quantity of the results as a plot shows it.
struct Quantity {
    std::string name; ///< in file names
    std::string axis; ///< with unit
    double (*of)(const ResultRow &);
    bool logarithmic;
};

void writeCsv(std::ostream &out, const std::vector<ResultRow> &rows);
/// A gnuplot script with its data inside that writes one SVG to standard output: the quantity over the
/// points, a curve an algorithm.
void writeGnuplot(std::ostream &out, const std::string &title, const Quantity &quantity,
                  const std::vector<ResultRow> &rows);
/// A LaTeX document that pdflatex compiles: one plot a quantity (pgfplots).
void writeLatex(std::ostream &out, const std::string &title, const std::vector<Quantity> &quantities,
                const std::vector<ResultRow> &rows);

} // namespace hermes
