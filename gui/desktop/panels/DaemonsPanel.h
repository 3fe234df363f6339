#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/desktop/model/NetworkSearch.h"

#include <QHash>
#include <QWidget>

class QLineEdit;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;

/// The tree of robots, their daemons and what these say of their health. Adds daemons by address, or those
/// that announce themselves on the network; starts, stops and restarts those that a supervisor runs.
class DaemonsPanel : public QWidget {
    Q_OBJECT
public:
    explicit DaemonsPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    void updateTree();
    void showDaemon(QTreeWidgetItem &item, const Robot &robot, const DaemonLink &daemon);
    void showChosen();
    void updateButtons();
    void addAddress();
    void addFound(const QStringList &urls);
    /// process.start, process.stop or process.restart of the chosen daemon.
    void ask(const QString &method);
    QWidget *makeButtons();

    Fleet &fleet_;
    QLineEdit *address_;
    QPushButton *find_;
    NetworkSearch search_;
    QTreeWidget *tree_;
    PlainLabel *hint_;
    MessageLabel *message_;
    QPushButton *start_, *stop_, *restart_;
    QHash<const void *, QTreeWidgetItem *> items_; // by Robot or DaemonLink
    bool isUpdating_ = false;
};

} // namespace hermes::desktop
