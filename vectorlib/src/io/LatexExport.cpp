#include "vectorlib/io/LatexExport.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY LatexExport::LatexExport(std::ostream &out, const std::string &title, As as)
    : out_(out)
    , as_(as) {
    const char *prefix = as == As::Document ? "" : "% ";
    if (as == As::Document)
        out << "\\documentclass[a4paper,10pt]{article}\n";
    else
        out << "% For \\input in a document with:\n";
    for (const char *line : {"\\usepackage[T1]{fontenc}", "\\usepackage[utf8]{inputenc}",
                             "\\usepackage{longtable}", "\\usepackage{tikz}"})
        out << prefix << line << '\n';
    if (as == As::Fragment)
        return;
    out << "\\usepackage[margin=2cm]{geometry}\n\\IfFileExists{lmodern.sty}{\\usepackage{lmodern}}{}\n"
           "\\setlength{\\parindent}{0pt}\n\\setlength{\\emergencystretch}{3em}\n\\begin{document}\n";
    if (!title.empty())
        out << "\\section*{" << latexText(title) << "}\n";
}

VECTORLIB_BODY void LatexExport::picture(const Picture &picture, const LatexFrame &frame) {
    if (as_ == As::Document && !picture.title().empty())
        out_ << "\\subsection*{" << latexText(picture.title()) << "}\n";
    drawing(picture, frame);
    out_ << "\n\n\\smallskip\n";
    legend(picture.layers());
}

VECTORLIB_BODY void LatexExport::table(const Table &table) {
    std::size_t columns = table.header.size();
    for (const auto &row : table.rows)
        columns = std::max(columns, row.size());
    if (columns == 0)
        return;
    if (!table.title.empty())
        out_ << "\\subsection*{" << latexText(table.title) << "}\n";
    const bool isLong = table.rows.size() > 40;
    const char *kind = isLong ? "longtable" : "tabular";
    out_ << (isLong ? "" : "\\sbox0{%\n") << "\\begin{" << kind << "}{l" << std::string(columns - 1, 'r')
         << "}\n\\hline\n";
    row(table.header, columns);
    out_ << "\\hline\n" << (isLong ? "\\endhead\n" : "");
    for (const auto &cells : table.rows)
        row(cells, columns);
    out_ << "\\hline\n\\end{" << kind << '}'
         << (isLong ? ""
                    : "}%\n\\ifdim\\wd0>\\linewidth\\resizebox{\\linewidth}{!}{\\usebox0}\\else\\usebox0\\fi")
         << "\n\n\\bigskip\n";
}

VECTORLIB_BODY void LatexExport::row(const std::vector<std::string> &cells, std::size_t columns) {
    for (std::size_t i = 0; i < columns; ++i)
        out_ << (i ? " & " : "") << (i < cells.size() ? cells[i] : "");
    out_ << " \\\\\n";
}

} // namespace vectorlib
