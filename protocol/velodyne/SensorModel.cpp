#include "protocol/velodyne/SensorModel.h"

namespace hermes::velodyne {

namespace {

/// VLP-16 manual, table of vertical angles by laser id.
constexpr std::array<double, 16> vlp16Elevation_deg = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                       -7,  9, -5,  11, -3,  13, -1, 15};
/// VLP-16 manual, table of vertical angles: "vertical correction (mm)", to be added to z.
constexpr std::array<double, 16> vlp16VerticalOffset_mm = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                                           5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
constexpr std::int64_t vlp16LaserPeriod_ns = 2304;
constexpr std::int64_t vlp16FiringPeriod_ns = 16 * vlp16LaserPeriod_ns + 18432;
static_assert(2 * vlp16FiringPeriod_ns == 110592, "of a block; 753.5 packets a second");

constexpr SensorModel hdl32eModel = {
    Model::Hdl32e,           "HDL-32E",       lasers,       1,
    laserPeriod_ns,          firingPeriod_ns, horizonLaser, elevation_deg.data(),
    verticalOffset_mm.data()};
constexpr SensorModel vlp16Model = {Model::Vlp16,
                                    "VLP-16",
                                    16,
                                    2,
                                    vlp16LaserPeriod_ns,
                                    vlp16FiringPeriod_ns,
                                    1, // +1 degree; 14 looks as far down
                                    vlp16Elevation_deg.data(),
                                    vlp16VerticalOffset_mm.data()};

} // namespace

int SensorModel::ring(int laser) const {
    int below = 0;
    for (int other = 0; other < lasers; ++other)
        below += elevation_deg[other] < elevation_deg[laser];
    return below;
}

const SensorModel &hdl32e() {
    return hdl32eModel;
}

const SensorModel &vlp16() {
    return vlp16Model;
}

const SensorModel *findSensorModel(Model model) {
    switch (model) {
    case Model::Blank:
    case Model::Hdl32e:
        return &hdl32eModel;
    case Model::Vlp16:
        return &vlp16Model;
    }
    return nullptr;
}

Model modelFromText(std::string_view text) {
    return text == "hdl32e" ? Model::Hdl32e : text == "vlp16" ? Model::Vlp16 : Model::Blank;
}

} // namespace hermes::velodyne
