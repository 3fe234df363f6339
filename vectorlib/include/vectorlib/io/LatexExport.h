#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/io/LatexPicture.h"
#include "vectorlib/io/Svg.h"

#include <iosfwd>
#include <ostream>
#include <string>
#include <vector>

namespace vectorlib {

/// A table; its cells are LaTeX, which latexText() makes of text; its title is text.
struct Table {
    std::string title;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
};

/// Writes pictures of scenes and tables as LaTeX, one after the other: a document that
/// pdflatex compiles, or a fragment to be included, whose first lines name the packages that it needs. Text
/// of any content is escaped. Thesis 4.2.2, LaTeXExport.
class LatexExport {
public:
    /// A document of its own, or a fragment that another document includes.
    enum class As { Document, Fragment };

    explicit LatexExport(std::ostream &out, const std::string &title = "", As as = As::Document);
    LatexExport(const LatexExport &) = delete;
    LatexExport &operator=(const LatexExport &) = delete;

    /// A scene with its title (in a document; beside a fragment stands what includes it) and legend.
    void picture(const Picture &picture, const LatexFrame &frame = {});
    /// The scene alone, where more stands beside it.
    void drawing(const Picture &picture, const LatexFrame &frame) {
        LatexPicture(picture, frame).write(out_);
    }
    /// What the layers with a label mean.
    void legend(const std::vector<Picture::Layer> &layers) {
        out_ << "{\\small\\raggedright\n";
        LatexPicture::writeLegend(out_, layers);
        out_ << "\\par}\n\\bigskip\n";
    }
    /// Rows that are shorter than others are filled up. Long tables go on on the next page, with their
    /// header; others that are wider than the page are made smaller.
    void table(const Table &table);
    /// A paragraph; any text.
    void text(const std::string &paragraph) { out_ << latexText(paragraph) << "\n\n"; }
    /// What is LaTeX already.
    void latex(const std::string &code) { out_ << code; }
    /// Two columns; each is a function that writes by this export. The left one takes that share of the
    /// width.
    template <typename Left, typename Right>
    void beside(double share, Left left, Right right) {
        column(share, 't', left);
        out_ << "\\hfill\n";
        column(0.98 - share, 't', right);
        out_ << "\n\\par\\bigskip\n";
    }

    /// The end of the document; nothing is written after it.
    void finish() {
        if (as_ == As::Document)
            out_ << "\\end{document}\n";
    }

private:
    template <typename Write>
    void column(double share, char at, Write write) {
        out_ << "\\begin{minipage}[" << at << "]{" << Fixed{share, 2} << "\\textwidth}\\vspace{0pt}\n";
        write();
        out_ << "\n\\end{minipage}";
    }
    void row(const std::vector<std::string> &cells, std::size_t columns);

    std::ostream &out_;
    As as_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/LatexExport.cpp")
