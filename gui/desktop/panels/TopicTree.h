#pragma once

#include "gui/desktop/model/TopicFields.h"
#include "gui/desktop/model/TopicMeter.h"

#include <QTimer>
#include <QTreeWidget>
#include <functional>
#include <memory>
#include <set>

namespace hermes::desktop {

/// All topics of all daemons with their rate and age, and in each the numbers that can be plotted, with a
/// tick. They are known from the daemon's description, or from the first message.
class TopicTree : public QTreeWidget {
    Q_OBJECT
public:
    /// isPlotted: what is ticked.
    TopicTree(Fleet &fleet, std::function<bool(const FieldId &)> isPlotted, QWidget *parent = nullptr);
    ~TopicTree() override;

    /// The topic of the current row; null: none.
    std::pair<DaemonLink *, QString> chosenTopic() const;
    /// Ticks what is plotted now, and opens topics of which something is.
    void showTicks(const std::vector<FieldId> &plotted);

Q_SIGNALS:
    void ticked(const hermes::desktop::FieldId &field, bool isOn);
    void topicChosen();
    /// What it waits for, or found; empty: nothing to say.
    void told(const QString &text);

protected:
    void resizeEvent(QResizeEvent *event) override;

private:
    void listTopics();
    void dropGone();
    QTreeWidgetItem *rowOf(DaemonLink *daemon);
    void addTopics(QTreeWidgetItem *row, DaemonLink *daemon);
    void addTopic(QTreeWidgetItem *row, const QString &topic, const QJsonObject &description);
    void open(QTreeWidgetItem *topic);
    void addFields(QTreeWidgetItem *topic, const QStringList &paths);
    void take(QTreeWidgetItem *topic, const TopicUpdate &update);
    void onItemChanged(QTreeWidgetItem *item);
    void measureAll();
    void measure(QTreeWidgetItem *topic);
    bool isMeasured(QTreeWidgetItem *topic) const;

    Fleet &fleet_;
    const std::function<bool(const FieldId &)> isPlotted_;
    std::map<QTreeWidgetItem *, std::unique_ptr<TopicMeter>> meters_;
    std::set<QTreeWidgetItem *> opening_;      ///< topics whose next message tells their fields
    std::map<QString, QSet<QString>> plotted_; ///< topics, by the address of their daemon
    QTimer timer_;
    bool isListing_ = false, isSeen_ = false;
};

} // namespace hermes::desktop
