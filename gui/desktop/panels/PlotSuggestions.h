#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/desktop/model/TopicFields.h"

#include <QWidget>

class QGridLayout;

namespace hermes::desktop {

/// A few plots that are one click away while nothing is plotted: numbers of the chosen robot that belong
/// together, as their units tell.
class PlotSuggestions : public QWidget {
    Q_OBJECT
public:
    explicit PlotSuggestions(Fleet &fleet, QWidget *parent = nullptr);

Q_SIGNALS:
    void wanted(const std::vector<hermes::desktop::FieldId> &fields);

private:
    struct Suggestion {
        QString text;
        std::vector<FieldId> fields;
    };

    std::vector<Suggestion> find() const;
    void refresh();

    Fleet &fleet_;
    QGridLayout *grid_;
    QStringList topics_, shown_;
};

} // namespace hermes::desktop
