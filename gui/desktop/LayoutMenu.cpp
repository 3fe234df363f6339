#include "gui/desktop/LayoutMenu.h"

#include "gui/desktop/LayoutKeeper.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QActionGroup>
#include <QInputDialog>
#include <QLineEdit>

namespace hermes::desktop {

LayoutMenu::LayoutMenu(const Layouts &layouts, const LayoutKeeper &keeper, QWidget *parent)
    : QMenu(tr("Layout"), parent)
    , layouts_(layouts)
    , keeper_(keeper)
    , removal_(new QMenu(this)) {
    setObjectName("layoutMenu");
    removal_->addAction(tr("Delete &now"), this, &LayoutMenu::removalWanted)->setObjectName("removeLayout");
    connect(this, &QMenu::aboutToShow, this, &LayoutMenu::fill);
    fill();
}

void LayoutMenu::fill() {
    clear();
    addProblem();
    auto *const group = new QActionGroup(this);
    connect(this, &QMenu::aboutToShow, group, &QObject::deleteLater);
    for (const QString &name : layouts_.names()) {
        QAction *const action = addAction(labelText(name), this, [this, name] { Q_EMIT chosen(name); });
        action->setObjectName("layout " + name);
        action->setActionGroup(group);
        action->setCheckable(true);
        action->setChecked(name == layouts_.current());
    }
    addSeparator();
    addAction(tr("&Save as..."), this, &LayoutMenu::askName)->setObjectName("saveLayoutAs");
    addAction(tr("&Default arrangement"), this, &LayoutMenu::resetWanted)->setObjectName("resetLayout");
    addMenu(removal_);
    removal_->setTitle(tr("D&elete %1").arg(labelText(layouts_.current())));
    removal_->menuAction()->setEnabled(layouts_.names().size() > 1);
}

/// Why nothing of it is kept.
void LayoutMenu::addProblem() {
    const QString problem = layouts_.problem() + keeper_.problem();
    if (problem.isEmpty())
        return;
    auto *const note = addAction(labelText(shortLine(problem, 120)));
    note->setObjectName("layoutsNotKept");
    note->setEnabled(false);
    addSeparator();
}

void LayoutMenu::askName() {
    auto *const dialog = new QInputDialog(parentWidget());
    dialog->setObjectName("layoutName");
    dialog->setWindowTitle(tr("Save the layout as"));
    dialog->setLabelText(tr("Panels and plots as they are now, by this name:"));
    connect(dialog, &QInputDialog::textValueSelected, this, &LayoutMenu::savedAs);
    question_.show(dialog);
    if (auto *const field = dialog->findChild<QLineEdit *>())
        field->setMaxLength(Layouts::longestName);
}

} // namespace hermes::desktop
