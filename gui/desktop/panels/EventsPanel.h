#pragma once

#include "gui/desktop/model/EventTable.h"
#include "gui/desktop/widgets/Sounds.h"

#include <QSet>
#include <QWidget>

class QTreeView;

namespace hermes::desktop {

/// What has happened and what is wrong, in one list, to be acknowledged one by one or all at once.
class EventsPanel : public QWidget {
    Q_OBJECT
public:
    EventsPanel(Events &events, Sounds &sounds, QWidget *parent = nullptr);

private:
    void acknowledgeChosen();

    Events &events_;
    EventTable table_;
    QTreeView *view_;
    QSet<quint64> chosen_; ///< while the rows change
};

} // namespace hermes::desktop
