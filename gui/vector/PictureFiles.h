#pragma once

#include "gui/vector/Output.h"
#include "vectorlib/io/Svg.h"

namespace hermes::vector {

/// The picture that a command leaves beside its result: as SVG, as a LaTeX document, as both or not at all.
class PictureFiles {
public:
    /// Of an empty path none is made. What is wrong with a path is told before any work is done, see
    /// OutputSet::open().
    PictureFiles(OutputSet &files, const std::string &svg, const std::string &latex)
        : svg_(svg.empty() ? nullptr : &files.open(svg))
        , latex_(latex.empty() ? nullptr : &files.open(latex)) {}

    bool areWanted() const { return svg_ || latex_; }
    void write(vectorlib::SvgPicture picture) const;

private:
    std::ostream *svg_, *latex_;
};

} // namespace hermes::vector
