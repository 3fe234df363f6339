#include "gui/vector/BagDrive.h"

#include "common/progress/Progress.h"
#include "gui/vector/BagMessages.h"
#include "gui/vector/Failure.h"
#include "vectorlib/io/Number.h"

#include <algorithm>
#include <cmath>

namespace hermes::vector {

namespace {

constexpr double largestTilt_rad = 0.35; // 20 degrees

bool isLaser(const bag::Topic &topic) {
    return isOfType<ros::LaserScan>(topic) || isOfType<ros::MultiEchoLaserScan>(topic);
}
bool isScanner(const bag::Topic &topic) {
    return topic.messages > 0 && (isLaser(topic) || isOfType<ros::PointCloud>(topic));
}

/// Of a name with namespaces.
std::string lastPart(const std::string &name) {
    return name.substr(name.find_last_of('/') + 1);
}

std::string counted(std::size_t count, const std::string &what) {
    return std::to_string(count) + ' ' + what;
}

} // namespace

BagDrive::BagDrive(const std::string &path)
    : path_(path)
    , reader_(valueOrFail(bag::open(path))) {
    listTopics();
    readFrames();
    if (odometryTopic_.empty())
        way_ = wayTo("odom");
    wayToMap_ = wayTo("map");
    for (BagScanner &scanner : scanners_)
        placeScanner(scanner);
}

void BagDrive::note(const std::string &what) {
    if (std::find(notices_.begin(), notices_.end(), what) == notices_.end())
        notices_.push_back(what);
}

/// The scanners, and the topic of the odometry: of several the one that is called so, else that of most
/// messages.
void BagDrive::listTopics() {
    std::string others;
    const bag::Topic *odometry = nullptr;
    const auto rank = [](const bag::Topic &topic) {
        return std::pair(lastPart(topic.name) == "odom", topic.messages);
    };
    for (const bag::Topic &topic : reader_->topics()) {
        std::string fault;
        if (isScanner(topic)) {
            fault = isOfType<ros::LaserScan>(topic)            ? faultOf<ros::LaserScan>(topic)
                    : isOfType<ros::MultiEchoLaserScan>(topic) ? faultOf<ros::MultiEchoLaserScan>(topic)
                                                               : faultOf<ros::PointCloud>(topic);
            BagScanner scanner;
            scanner.topic = topic.name;
            scanner.type = topic.type;
            scanner.messages = topic.messages;
            scanner.problem = fault;
            scanners_.push_back(scanner);
        } else if (isOfType<ros::TfMessage>(topic)) {
            fault = faultOf<ros::TfMessage>(topic);
        } else if (isOdometry(topic)) {
            fault = faultOf<ros::Odometry>(topic);
            if (fault.empty() && (odometry == nullptr || rank(*odometry) < rank(topic)))
                odometry = &topic;
        }
        if (!fault.empty())
            note(fault);
    }
    if (odometry == nullptr)
        return;
    odometryTopic_ = odometry->name;
    for (const bag::Topic &topic : reader_->topics())
        if (isOdometry(topic) && topic.name != odometryTopic_)
            others += (others.empty() ? "" : ", ") + topic.name;
    if (!others.empty())
        note("the odometry is that of " + odometryTopic_ + ", not of " + others);
}

bool BagDrive::isNeeded(const bag::Topic &topic) const {
    const auto isFrameOpen = [&](const BagScanner &scanner) {
        return scanner.topic == topic.name && scanner.frame.empty() && scanner.problem.empty();
    };
    return (isFrames(topic)) || (topic.name == odometryTopic_ && base_.empty()) ||
           std::any_of(scanners_.begin(), scanners_.end(), isFrameOpen);
}

/// All frames of the bag, those of the odometry and of each scanner's first message.
void BagDrive::readFrames() {
    const auto &topics = reader_->topics();
    Progress progress("reading frames, messages");
    std::uint64_t total = 0, done = 0;
    for (const bag::Topic &topic : topics)
        total += isNeeded(topic) ? topic.messages : 0;
    reader_->select([this](const bag::Topic &topic) { return isNeeded(topic); });
    while (const auto message = reader_->next()) {
        if (++done % 256 == 0)
            progress.update(double(std::min(done, total)), double(total));
        if (isNeeded(topics[message->topic]))
            takeFrames(topics[message->topic], *message);
    }
}

void BagDrive::takeFrames(const bag::Topic &topic, const bag::Message &message) {
    if (isFrames(topic)) {
        const auto transforms = messageFrom<ros::TfMessage>(topic, message.data);
        refusedFrameMessages_ += !transforms;
        if (transforms)
            for (const ros::TransformStamped &transform : transforms->transforms)
                refusedFrames_ += !frames_.add(transform);
    } else if (topic.name == odometryTopic_) {
        const auto odometry = messageFrom<ros::Odometry>(topic, message.data);
        if (odometry)
            base_ = plainFrame(odometry->childFrameId);
    } else {
        readFirstScan(topic, message);
    }
}

void BagDrive::readFirstScan(const bag::Topic &topic, const bag::Message &message) {
    for (BagScanner &scanner : scanners_)
        if (scanner.topic == topic.name) {
            vectorlib::TimedScan scan;
            BagScan reading;
            scanner.problem = readScan(topic, message, reading, scan, scanner.frame);
            scanner.rays = scan.rays;
            scanner.fieldOfView = scan.fieldOfView;
            if (scanner.frame.empty())
                scanner.frame = "(none)"; // told so; it is in no tree
        }
}

/// Fills the scan but for its odometry. Gives why it is none; empty: it is one.
std::string BagDrive::readScan(const bag::Topic &topic, const bag::Message &message, BagScan &reading,
                               vectorlib::TimedScan &scan, std::string &frame) const {
    const auto read = [&](auto decoded) -> std::string {
        if (!decoded)
            return decoded.error();
        frame = plainFrame(decoded->header.frameId);
        scan.stamp = secondsOf(decoded->header.stamp);
        return reading.read(*decoded, scan);
    };
    return isOfType<ros::LaserScan>(topic) ? read(messageFrom<ros::LaserScan>(topic, message.data))
           : isOfType<ros::MultiEchoLaserScan>(topic)
               ? read(messageFrom<ros::MultiEchoLaserScan>(topic, message.data))
               : read(messageFrom<ros::PointCloud>(topic, message.data));
}

/// The robot's frame for a sensor in that one: the one below the first that moves, where the odometry has not
/// told it.
std::string BagDrive::baseOf(const std::string &frame) const {
    const std::vector<std::string> up = frames_.upFrom(frame);
    if (std::find(up.begin(), up.end(), base_) != up.end())
        return base_;
    for (std::size_t i = 0; i + 1 < up.size(); ++i)
        if (frames_.edge(up[i]).moves || lastPart(up[i + 1]) == "odom" || lastPart(up[i + 1]) == "map")
            return up[i];
    return up.size() > 1 || base_.empty() ? up.back() : base_;
}

/// Frames from the robot's up to one that is called so; none: it is not above the robot.
std::vector<std::string> BagDrive::wayTo(const char *name) const {
    for (const BagScanner &scanner : scanners_) {
        const std::vector<std::string> up = frames_.upFrom(baseOf(scanner.frame));
        const auto found = std::find_if(up.begin(), up.end(),
                                        [&](const std::string &frame) { return lastPart(frame) == name; });
        if (found != up.end() && found != up.begin())
            return {up.begin(), found + 1};
    }
    return {};
}

void BagDrive::placeScanner(BagScanner &scanner) {
    scanner.base = baseOf(scanner.frame);
    const auto place = frames_.between(scanner.frame, scanner.base);
    const bool isAlone = frames_.upFrom(scanner.frame).size() == 1 && scanner.frame != base_;
    if (!place || isAlone || !scanner.problem.empty())
        return;
    const double up = std::clamp(place->linear()(2, 2), -1.0, 1.0);
    scanner.mount = poseOf(*place);
    scanner.isUpsideDown = up < 0;
    scanner.tilt = std::acos(std::abs(up));
    for (const std::string &frame : frames_.upFrom(scanner.frame)) {
        if (frame == scanner.base)
            break;
        scanner.isMountMoving = scanner.isMountMoving || frames_.edge(frame).moves;
    }
}

std::string BagDrive::odometry() const {
    if (!odometryTopic_.empty())
        return odometryTopic_;
    return way_.empty() ? "" : "tf: " + way_.back() + " to " + way_.front();
}

void BagDrive::choose(const BagOptions &options) {
    const std::string wanted = plainFrame(options.topic);
    std::vector<std::size_t> lasers, all, named;
    std::string list;
    for (std::size_t i = 0; i < scanners_.size(); ++i) {
        const BagScanner &scanner = scanners_[i];
        list += (i == 0 ? "" : ", ") + scanner.topic + " (" + scanner.type + ", " +
                counted(scanner.messages, "messages") + ")";
        all.push_back(i);
        if (scanner.type != "sensor_msgs/PointCloud2")
            lasers.push_back(i);
        if (plainFrame(scanner.topic) == wanted)
            named.push_back(i);
    }
    const auto &found = !wanted.empty() ? named : lasers.empty() ? all : lasers;
    if (all.empty())
        throw Failure(
            path_ + ": found no topic of a scanner among " + counted(reader_->topics().size(), "topics") +
            ", expected sensor_msgs/LaserScan, MultiEchoLaserScan or PointCloud2; hermes-vector info lists "
            "what is there" +
            (reader_->problem().empty() ? "" : "; " + reader_->problem()));
    if (found.empty())
        throw Failure(path_ + ": found no scanner " + options.topic + ", expected one of " + list);
    if (found.size() > 1)
        throw Failure(path_ + ": found several scanners, " + list + ", expected --topic to name one");
    chosen_ = found[0];
    cloud_ = options.cloud;
    if (!scanner().problem.empty())
        throw Failure(path_ + ": " + scanner().topic + ": " + scanner().problem);
    for (const std::size_t i : all)
        if (i != chosen_)
            note("left out: " + scanners_[i].topic);
}

void BagDrive::begin() {
    for (const bag::Topic &known : reader_->topics())
        if (known.name == scanner().topic && known.type == scanner().type)
            scanTopic_ = &known;
    reader_->select([&](const bag::Topic &known) { return &known == scanTopic_; });
    reading_ = BagScan(cloud_);
    if (!odometryTopic_.empty())
        odometry_ = std::make_unique<BagOdometry>(path_, odometryTopic_);
    else if (!way_.empty())
        odometry_ = std::make_unique<BagOdometry>(path_, way_, frames_);
}

std::optional<std::uint64_t> BagDrive::nextScan(vectorlib::TimedScan &scan) {
    std::string frame;
    while (const auto message = reader_->next()) {
        const std::string why = readScan(*scanTopic_, *message, reading_, scan, frame);
        if (!why.empty() && refusedScans_++ == 0)
            firstRefused_ = "message " + std::to_string(scans_) + " of " + scanTopic_->name + ": " + why;
        ++scans_;
        if (!why.empty())
            continue;
        if (scan.stamp == 0) {
            scan.stamp = 1e-9 * double(message->time_ns);
            ++unstamped_;
        }
        if (scanner().isUpsideDown)
            hangUpsideDown(scan);
        scan.odometry.reset();
        return message->time_ns;
    }
    return std::nullopt;
}

std::optional<vectorlib::Pose2D> BagDrive::poseAt(const vectorlib::TimedScan &scan) {
    if (wayToMap_.empty())
        return std::nullopt;
    if (!poses_)
        poses_ = std::make_unique<BagOdometry>(path_, wayToMap_, frames_);
    const auto track = poseFeed_.over(scan.stamp, scan.stamp, [this] { return poses_->nextSample(); });
    return track ? std::optional(track->at(scan.stamp).pose()) : std::nullopt;
}

void BagDrive::readScans(const std::function<void(vectorlib::TimedScan &scan)> &take) {
    begin();
    for (vectorlib::TimedScan scan; nextScan(scan); take(scan))
        if (odometry_ && !scan.points.empty()) {
            scan.odometry = feed_.over(scan.begin(), scan.end(), [this] { return odometry_->nextSample(); });
            withoutOdometry_ += !scan.odometry;
        }
}

std::string BagDrive::notices(bool isPlaced) const {
    std::vector<std::string> all = notices_;
    const auto add = [&](bool isTrue, const std::string &text) {
        if (isTrue)
            all.push_back(text);
    };
    const BagScanner &s = scanner();
    add(!s.mount && !isPlaced,
        "where " + s.frame + " is on the robot is not told: it is taken for the robot's centre");
    add(s.isMountMoving && !isPlaced, s.frame + " moves on the robot: its first place is taken");
    add(s.tilt > largestTilt_rad, s.frame + " is tilted by " +
                                      std::to_string(std::lround(s.tilt * 180 / vectorlib::pi)) +
                                      " degrees: it is taken as level");
    add(odometry().empty(), "there is no odometry: no nav_msgs/Odometry, and no frame odom above " + s.base);
    add(refusedScans_ > 0, counted(refusedScans_, "scan(s) cannot be read, the first: ") + firstRefused_);
    add(unstamped_ > 0, counted(unstamped_, "scan(s) without a stamp: they have that of the bag"));
    add(withoutOdometry_ > 0,
        counted(withoutOdometry_, "scan(s) are of times of which the odometry tells nothing"));
    add(refusedFrames_ > 0, counted(refusedFrames_, "transform(s) of tf are none"));
    add(refusedFrameMessages_ > 0, counted(refusedFrameMessages_, "message(s) of tf cannot be read"));
    add(!reader_->problem().empty(), path_ + ": " + reader_->problem());
    const std::string ofOdometry = odometry_ ? odometry_->problem() : "";
    add(!ofOdometry.empty() && ofOdometry != reader_->problem(), path_ + ", odometry: " + ofOdometry);
    std::string text;
    for (const std::string &one : all)
        text += (text.empty() ? "" : "; ") + one;
    return text;
}

} // namespace hermes::vector
