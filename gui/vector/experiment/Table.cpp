#include "gui/vector/experiment/Table.h"

#include "gui/vector/experiment/Algorithms.h"
#include "vectorlib/io/Number.h"

#include <algorithm>

namespace hermes {

using vectorlib::Number;

namespace {

/// The rows of one algorithm, with its colour.
struct Curve {
    std::string label;
    std::string colour;
    std::vector<const ResultRow *> rows;
};

std::vector<Curve> curves(const std::vector<ResultRow> &rows) {
    std::vector<Curve> result;
    for (const Algorithm &algorithm : comparedAlgorithms(1, false)) {
        Curve curve{algorithm.label, algorithm.colour, {}};
        for (const ResultRow &row : rows)
            if (row.algorithm == algorithm.label)
                curve.rows.push_back(&row);
        if (!curve.rows.empty())
            result.push_back(std::move(curve));
    }
    return result;
}

// A logarithmic axis has no place for 0.
bool shows(const Quantity &quantity, const ResultRow &row) {
    return !quantity.logarithmic || quantity.of(row) > 0;
}

} // namespace

void writeCsv(std::ostream &out, const std::vector<ResultRow> &rows) {
    out << "sigma,points,algorithm,runs,lines_true,lines_found,lines_percent,area_m2,time_us\n";
    for (const ResultRow &r : rows)
        out << Number(r.sigma) << ',' << r.points << ',' << r.algorithm << ',' << r.runs << ','
            << Number(r.linesTrue) << ',' << Number(r.linesFound) << ',' << Number(r.linesPercent()) << ','
            << Number(r.area) << ',' << Number(r.microseconds) << '\n';
}

void writeGnuplot(std::ostream &out, const std::string &title, const Quantity &quantity,
                  const std::vector<ResultRow> &rows) {
    const std::vector<Curve> all = curves(rows);
    out << "set terminal svg size 720,460 font 'sans-serif,13' background '#ffffff'\n"
        << "set title '" << title << "'\nset xlabel 'points'\nset ylabel '" << quantity.axis << "'\n"
        << "set logscale x\nset grid lc rgb '#dddddd'\nset key left top\n";
    if (quantity.logarithmic)
        out << "set logscale y\n";
    out << "plot";
    for (std::size_t i = 0; i < all.size(); ++i)
        out << (i ? "," : "") << " '-' using 1:2 with linespoints pt 7 ps 0.5 lw 2 lc rgb '" << all[i].colour
            << "' title '" << all[i].label << "'";
    out << '\n';
    for (const Curve &curve : all) {
        for (const ResultRow *row : curve.rows)
            if (shows(quantity, *row))
                out << row->points << ' ' << Number(quantity.of(*row)) << '\n';
        out << "e\n";
    }
}

void writeLatex(std::ostream &out, const std::string &title, const std::vector<Quantity> &quantities,
                const std::vector<ResultRow> &rows) {
    out << "\\documentclass{article}\n\\usepackage{pgfplots}\n\\pgfplotsset{compat=1.16}\n\\begin{document}\n"
        << "\\section*{" << title << "}\n";
    for (const Quantity &quantity : quantities) {
        out << "\\begin{tikzpicture}\\begin{axis}[xmode=log, " << (quantity.logarithmic ? "ymode=log, " : "")
            << "xlabel={points}, ylabel={" << quantity.axis
            << "}, grid=major, legend pos=outer north east]\n";
        for (const Curve &curve : curves(rows)) {
            std::string rgb = curve.colour.substr(1);
            std::transform(rgb.begin(), rgb.end(), rgb.begin(),
                           [](unsigned char c) { return std::toupper(c); });
            out << "\\definecolor{" << curve.label << "}{HTML}{" << rgb
                << "}\n\\addplot[color=" << curve.label << ", mark=*, mark size=1pt, thick] coordinates {";
            for (const ResultRow *row : curve.rows)
                if (shows(quantity, *row))
                    out << " (" << row->points << ',' << Number(quantity.of(*row)) << ')';
            out << "};\n\\addlegendentry{" << curve.label << "}\n";
        }
        out << "\\end{axis}\\end{tikzpicture}\n\n";
    }
    out << "\\end{document}\n";
}

} // namespace hermes
