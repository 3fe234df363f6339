#include "daemons/ros2/NodeGraph.h"

#include "common/Log.h"
#include "protocol/ros/Cdr.h"
#include "protocol/ros/Graph.h"

namespace hermes::ros2 {
namespace {

constexpr char discoveryTopic[] = "ros_discovery_info";
constexpr std::size_t maxParticipants = 1000; // that are remembered

template <std::size_t bytes>
ros::Gid<bytes> gidOf(const Guid &guid) {
    ros::Gid<bytes> gid;
    std::copy(guid.begin(), guid.end(), gid.data.begin());
    return gid;
}

template <std::size_t bytes>
Guid guidOfGid(const ros::Gid<bytes> &gid) {
    Guid guid{};
    std::copy_n(gid.data.begin(), guid.size(), guid.begin());
    return guid;
}

} // namespace

NodeGraph::NodeGraph(Participant &participant, GraphForm form, const QString &space, const QString &name)
    : participant_(participant)
    , form_(form)
    , space_(space)
    , name_(name) {
    soon_.setSingleShot(true);
    connect(&soon_, &QTimer::timeout, this, &NodeGraph::tell);
    auto reader = participant.read(discoveryTopic, ros::typeOf<ros::ParticipantEntities<16>>(),
                                   {true, true, 0}, [this](const Reader::Sample &sample) { hear(sample); });
    if (reader)
        reader_ = reader.take();
    else
        logWarning("graph", reader.error().message);
}

void NodeGraph::setEndpoints(std::vector<Guid> readers, std::vector<Guid> writers) {
    readers_ = std::move(readers);
    writers_ = std::move(writers);
    soon_.start(0);
}

QString NodeGraph::nodeOf(const Guid &writer) const {
    for (const auto &[participant, nodes] : others_)
        if (const auto found = nodes.find(writer); found != nodes.end())
            return found->second;
    return {};
}

/// The bytes of one form cannot be read as the other: what is left over is too much.
void NodeGraph::hear(const Reader::Sample &sample) {
    if (writer_ && sample.writer == writer_->guid())
        return;
    const GraphForm heard = hearAs<24>(sample)   ? GraphForm::Humble
                            : hearAs<16>(sample) ? GraphForm::Jazzy
                                                 : GraphForm::None;
    if (form_ != GraphForm::Auto || heard == GraphForm::None)
        return;
    logInfo("graph", QString("other nodes are of ROS 2 %1: so is this one")
                         .arg(heard == GraphForm::Humble ? "Humble" : "Iron or newer"));
    form_ = heard;
    soon_.start(0);
}

template <std::size_t bytes>
bool NodeGraph::hearAs(const Reader::Sample &sample) {
    const auto entities = ros::fromCdr<ros::ParticipantEntities<bytes>>(sample.cdr);
    if (!entities)
        return false;
    const Guid participant = guidOfGid(entities->participant);
    if (others_.size() >= maxParticipants && others_.count(participant) == 0)
        others_.erase(others_.begin());
    std::map<Guid, QString> &nodes = others_[participant];
    nodes.clear();
    for (const auto &node : entities->nodes) {
        const QString space = QString::fromStdString(node.space);
        const QString name = space + (space.endsWith('/') ? "" : "/") + QString::fromStdString(node.name);
        for (const auto &writer : node.writers)
            nodes[guidOfGid(writer)] = name.left(200);
    }
    return true;
}

void NodeGraph::tell() {
    if (form_ != GraphForm::Humble && form_ != GraphForm::Jazzy)
        return;
    if (!writer_) {
        auto writer =
            participant_.write(discoveryTopic, ros::typeOf<ros::ParticipantEntities<16>>(), {true, true, 1});
        if (!writer)
            return logWarning("graph", writer.error().message);
        writer_ = writer.take();
    }
    writer_->write(form_ == GraphForm::Humble ? told<24>() : told<16>());
}

template <std::size_t bytes>
std::string NodeGraph::told() const {
    ros::NodeEntities<bytes> node;
    node.space = space_.toStdString();
    node.name = name_.toStdString();
    for (const Guid &reader : readers_)
        node.readers.push_back(gidOf<bytes>(reader));
    for (const Guid &writer : writers_)
        node.writers.push_back(gidOf<bytes>(writer));
    return ros::toCdr(ros::ParticipantEntities<bytes>{gidOf<bytes>(participant_.guid()), {std::move(node)}});
}

} // namespace hermes::ros2
