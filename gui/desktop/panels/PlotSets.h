#pragma once

#include "gui/desktop/widgets/OneDialog.h"

#include <QJsonObject>
#include <QMenu>

namespace hermes::desktop {

/// The menu of the sets of plots that are kept by name: choose one, save what is plotted as one, delete one.
class PlotSets : public QMenu {
    Q_OBJECT
public:
    static constexpr int maxSets = 100, longestName = 40;

    explicit PlotSets(QWidget *parent = nullptr);

    /// All, by name.
    const QJsonObject &sets() const { return sets_; }
    void setSets(const QJsonObject &sets);
    /// Keeps a set under a name, in the place of one that had it.
    void save(const QString &name, const QJsonObject &set);

Q_SIGNALS:
    void chosen(const QJsonObject &set);
    /// Somebody gave a name for what is plotted now.
    void saveWanted(const QString &name);
    void changed();

private:
    void refill();
    void askName();
    void drop(const QString &name);

    QJsonObject sets_;
    QMenu *deletion_;
    OneDialog question_;
};

} // namespace hermes::desktop
