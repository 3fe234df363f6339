#pragma once

#include "gui/desktop/model/TopicMeter.h"

#include <QTimer>
#include <QTreeWidget>
#include <memory>

namespace hermes::desktop {

class PlainLabel;

/// The newest message of a topic as a tree: names, values and units, of long lists and deep nesting as much
/// as somebody reads. Ten times a second, while it is seen.
class MessageView : public QWidget {
    Q_OBJECT
public:
    explicit MessageView(QWidget *parent = nullptr);
    ~MessageView() override;

    /// None: null.
    void follow(DaemonLink *daemon, const QString &topic);

private:
    void refresh();
    void take(const TopicUpdate &update);
    void fill(QTreeWidgetItem *item, WireView value, const QJsonObject &schema, int depth);
    void fillChildren(QTreeWidgetItem *item, WireView value, const QJsonObject &schema, int depth);
    void showAge();

    QPointer<DaemonLink> daemon_;
    QString topic_;
    QJsonObject schema_;
    std::unique_ptr<TopicMeter> meter_;
    double stamp_ = 0;
    int room_ = 0; ///< rows that may still come
    PlainLabel *head_;
    QTreeWidget *tree_;
    QTimer timer_;
};

} // namespace hermes::desktop
