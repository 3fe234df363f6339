#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QHash>
#include <QTreeWidget>
#include <functional>

namespace hermes::desktop {

/// The robots, their daemons and what these say of their health. What the operator clicks at is chosen; a
/// robot is named and removed by its context menu, a daemon put to another robot by its own.
class DaemonTree : public QTreeWidget {
    Q_OBJECT
public:
    explicit DaemonTree(Fleet &fleet, QWidget *parent = nullptr);

    /// It takes what room there is: what is told below it stays in sight in a low window.
    QSize sizeHint() const override { return {QTreeWidget::sizeHint().width(), leastHeight}; }

    /// The row of this address is brought into sight and chosen.
    void lookFor(const QString &address);

Q_SIGNALS:
    /// Another row was chosen.
    void clickedAt();
    /// With the mouse, so that the keys may drive.
    void takenByMouse();
    /// The operator wants to be rid of it.
    void removalAsked(hermes::desktop::Robot *robot);

protected:
    void contextMenuEvent(QContextMenuEvent *event) override;
    void mousePressEvent(QMouseEvent *event) override;
    void mouseReleaseEvent(QMouseEvent *event) override;

private:
    QTreeWidgetItem *rowOf(const void *shown, QTreeWidgetItem *parent, int row);
    void update();
    void dropRows();
    void showRobot(QTreeWidgetItem &item, const Robot &robot);
    void showDaemon(QTreeWidgetItem &item, const Robot &robot, const DaemonLink &daemon);
    void showHealth(QTreeWidgetItem &item, const DaemonLink &daemon);
    void showChoice();
    void choose();
    void showMenu(QTreeWidgetItem *item, const QPoint &place);
    void add(QMenu &menu, const QString &text, const QString &name, const std::function<void()> &work);
    void rename(QTreeWidgetItem *item);
    Robot *robotOf(const QTreeWidgetItem *item) const;

    static constexpr int leastHeight = 60;

    Fleet &fleet_;
    QHash<const void *, QTreeWidgetItem *> items_, shown_; // by Robot or DaemonLink
    bool isUpdating_ = false;
};

} // namespace hermes::desktop
