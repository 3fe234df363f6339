#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/desktop/model/NetworkSearch.h"

#include <QWidget>

class QLineEdit;
class QPushButton;

namespace hermes::desktop {

class DaemonTree;
class MessageLabel;
class PlainLabel;

/// The tree of robots, their daemons and what these say of their health. Adds daemons by address, or those
/// that announce themselves on the network; removes robots; starts, stops and restarts what a supervisor
/// runs.
class DaemonsPanel : public QWidget {
    Q_OBJECT
public:
    explicit DaemonsPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    void update();
    void updateButtons();
    void addAddress();
    void addFound(const QStringList &urls);
    void remove(Robot *robot);
    void bringBack();
    /// process.start, process.stop or process.restart of the chosen daemon.
    void ask(const QString &method);
    QLayout *makeButtons();
    /// The process of the chosen daemon and who runs it; null: not known, or not connected.
    using Supervised = std::pair<const ProcessStatus *, DaemonLink *>;
    Supervised chosen() const;

    Fleet &fleet_;
    QLineEdit *address_;
    QPushButton *find_;
    NetworkSearch search_;
    DaemonTree *tree_;
    PlainLabel *hint_;
    MessageLabel *message_;
    QPushButton *undo_, *start_, *stop_, *restart_;
    QStringList removed_; ///< what brings back the robot that was removed last
};

} // namespace hermes::desktop
