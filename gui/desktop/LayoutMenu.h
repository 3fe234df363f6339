#pragma once

#include "gui/desktop/widgets/OneDialog.h"

#include <QMenu>

namespace hermes::desktop {

class LayoutKeeper;
class Layouts;

/// The layouts of the window by name, and what can be done with them. Who makes the window does it.
class LayoutMenu : public QMenu {
    Q_OBJECT
public:
    explicit LayoutMenu(const Layouts &layouts, const LayoutKeeper &keeper, QWidget *parent = nullptr);

Q_SIGNALS:
    void chosen(const QString &name);
    void savedAs(const QString &name);
    /// The current one.
    void resetWanted();
    void removalWanted();

private:
    void fill();
    void addProblem();
    void askName();

    const Layouts &layouts_;
    const LayoutKeeper &keeper_;
    QMenu *removal_;
    OneDialog question_;
};

} // namespace hermes::desktop
