#pragma once

#include "daemons/ros2/Participant.h"

#include <QTimer>
#include <map>
#include <optional>

namespace hermes::ros2 {

/// The form of `ros_discovery_info`: one that others do not have makes their `ros2 node list` fail.
enum class GraphForm {
    None,
    Humble, ///< ids of 24 bytes
    Jazzy,  ///< ids of 16 bytes, from Iron on
    Auto    ///< that of the others; nothing is told until one is heard
};

/// Which node has which endpoints: tells it of ours, and knows it of others.
class NodeGraph : public QObject {
public:
    NodeGraph(Participant &participant, GraphForm form, const QString &space, const QString &name);

    /// Ours; all of them, whenever one is new.
    void setEndpoints(std::vector<Guid> readers, std::vector<Guid> writers);
    /// "/space/name" of the node that has this writer; empty: not known.
    QString nodeOf(const Guid &writer) const;
    GraphForm form() const { return form_; }

private:
    void hear(const Reader::Sample &sample);
    template <std::size_t bytes>
    bool hearAs(const Reader::Sample &sample);
    void tell();
    template <std::size_t bytes>
    std::string told() const;

    Participant &participant_;
    GraphForm form_;
    const QString space_, name_;
    std::vector<Guid> readers_, writers_;
    /// Of each participant, the nodes of its writers.
    std::map<Guid, std::map<Guid, QString>> others_;
    std::unique_ptr<Reader> reader_;
    std::unique_ptr<Writer> writer_;
    QTimer soon_; ///< endpoints come in dozens
};

} // namespace hermes::ros2
