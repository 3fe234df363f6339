#include "gui/vector/PictureFiles.h"

#include "vectorlib/io/LatexExport.h"

namespace hermes::vector {

void PictureFiles::write(vectorlib::SvgPicture picture) const {
    if (svg_)
        picture.write(*svg_);
    if (!latex_)
        return;
    vectorlib::LatexExport document(*latex_);
    document.picture(picture);
    document.finish();
}

} // namespace hermes::vector
