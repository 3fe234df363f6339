#include "gui/desktop/drive/DriveGamepad.h"

#include <QJsonArray>
#include <QJsonDocument>

namespace hermes::desktop {
namespace {

constexpr std::size_t maxSamples = 60000; // of a calibration: twenty minutes

QString keyOf(const QString &kind) {
    return "gamepads/" + kind;
}

} // namespace

DriveGamepad::DriveGamepad(DriveControl &drive, Layouts &kept, QObject *parent)
    : QObject(parent)
    , drive_(drive)
    , kept_(kept)
    , pad_(this) {
    connect(&pad_, &Gamepad::changed, this, [this] {
        if (pad_.kind() != kind_)
            load();
        steer();
        Q_EMIT changed();
    });
    connect(&pad_, &Gamepad::stopPressed, &drive, &DriveControl::stop);
    resting_.setSingleShot(true);
    connect(&resting_, &QTimer::timeout, this, [this] { enter(Step::Move); });
    sampling_.setInterval(Gamepad::period);
    connect(&sampling_, &QTimer::timeout, this, &DriveGamepad::sample);
}

void DriveGamepad::steer() {
    const auto [leftX, leftY, rightX] = sticks();
    mustRelease_ = pad_.isDeadManHeld() && (mustRelease_ || step_ != Step::None);
    const bool isHeld = pad_.isDeadManHeld() && !mustRelease_;
    drive_.steer("gamepad", isHeld ? Twist2D{-leftY, -leftX, -rightX} : Twist2D(), isHeld);
}

void DriveGamepad::beginCalibration() {
    if (!pad_.isPlugged())
        return;
    atRest_.clear();
    moved_.clear();
    enter(Step::Rest);
    resting_.start(restFor);
    sampling_.start();
}

void DriveGamepad::sample() {
    auto &samples = step_ == Step::Rest ? atRest_ : moved_;
    if (samples.size() < maxSamples)
        samples.push_back(pad_.sticks());
}

Result<void> DriveGamepad::endCalibration() {
    if (step_ != Step::Move)
        return Error(ErrorCode::NotReady, tr("no calibration is under way"));
    const auto made = GamepadCalibration::of(atRest_, moved_);
    enter(Step::None);
    if (!made)
        return made.error();
    keep(*made);
    return {};
}

void DriveGamepad::useDefaults() {
    enter(Step::None);
    keep({});
}

void DriveGamepad::enter(Step step) {
    step_ = step;
    if (step == Step::None) {
        resting_.stop();
        sampling_.stop();
    }
    steer();
    Q_EMIT changed();
}

void DriveGamepad::load() {
    kind_ = pad_.kind();
    calibration_ = {};
    if (step_ != Step::None)
        enter(Step::None); // it was of another one
    if (!kind_.isEmpty())
        calibration_ = GamepadCalibration::fromList(
            QJsonDocument::fromJson(kept_.value(keyOf(kind_)).toUtf8()).array().toVariantList());
}

void DriveGamepad::keep(const GamepadCalibration &calibration) {
    calibration_ = calibration;
    if (!kind_.isEmpty())
        kept_.setValue(keyOf(kind_), compactText(QJsonArray::fromVariantList(calibration.toList())));
    Q_EMIT changed();
}

} // namespace hermes::desktop
