#include "gui/vector/Points.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/io/CsvPoints.h"
#include "vectorlib/io/Pcd.h"

namespace hermes::vector {

namespace {

[[noreturn]] void refuse(const std::string &path, const char *found) {
    throw Failure(path + ": found a " + found +
                  ", expected one scan; take scan number N out of it by: hermes-vector map " + path +
                  " --scan N --out scan.csv");
}

} // namespace

std::vector<vectorlib::Vector2D<double>> loadPoints(const std::string &path) {
    Input input(path);
    TextStream in(readScanText(input, path));
    return valueOrFail(hasExtension(path, ".pcd") ? vectorlib::readPcd<double>(in, input.name())
                                                  : vectorlib::readCsvPoints<double>(in, input.name()));
}

std::string readScanText(Input &input, const std::string &path) {
    if (input.isCapture())
        refuse(path, "capture");
    std::string text = input.readAll();
    for (const std::string word : {"FLASER ", "ROBOTLASER1 "})
        if (text.rfind(word, 0) == 0 || text.find('\n' + word) != std::string::npos)
            refuse(path, "CARMEN log");
    return text;
}

} // namespace hermes::vector
