#pragma once

#include "gui/desktop/model/Events.h"
#include "gui/desktop/widgets/Sounds.h"

#include <QTimer>
#include <QWidget>

class QPushButton;

namespace hermes::desktop {

class PlainLabel;

/// One line at the foot of the window: the worst event that waits to be acknowledged, else what happened
/// last. It sounds when an error comes, at most once in two seconds.
class EventBar : public QWidget {
    Q_OBJECT
public:
    EventBar(Events &events, const Sounds &sounds, QWidget *parent = nullptr);

Q_SIGNALS:
    /// The list of all is wanted.
    void listWanted();

private:
    void update();

    Events &events_;
    const Sounds &sounds_;
    PlainLabel *text_;
    PlainLabel *others_; // how many wait beside it
    QPushButton *acknowledge_;
    quint64 shown_ = 0; ///< the event that Acknowledge means
    QTimer refresh_, quiet_;
};

} // namespace hermes::desktop
