#include "gui/desktop/panels/PlotSets.h"

#include "gui/desktop/widgets/ForeignText.h"

#include <QInputDialog>

namespace hermes::desktop {

PlotSets::PlotSets(QWidget *parent)
    : QMenu(parent)
    , deletion_(new QMenu(tr("Delete a set"), this)) {
    setObjectName("sets");
    connect(this, &QMenu::aboutToShow, this,
            &PlotSets::refill); // not while one of its actions is carried out
    refill();
}

void PlotSets::setSets(const QJsonObject &sets) {
    sets_ = {};
    for (auto set = sets.begin(); set != sets.end() && sets_.size() < maxSets; ++set)
        if (!set.key().isEmpty() && set.value().isObject())
            sets_[shortLine(set.key(), longestName)] = set.value();
}

void PlotSets::save(const QString &name, const QJsonObject &set) {
    const QString shown = shortLine(name.trimmed(), longestName);
    if (shown.isEmpty() || (!sets_.contains(shown) && sets_.size() >= maxSets))
        return;
    sets_[shown] = set;
    Q_EMIT changed();
}

void PlotSets::drop(const QString &name) {
    sets_.remove(name);
    Q_EMIT changed();
}

void PlotSets::refill() {
    clear();
    deletion_->clear();
    const QStringList names = sets_.keys();
    for (const QString &name : names) {
        const QString text = labelText(name);
        addAction(text, this, [this, name] { Q_EMIT chosen(sets_[name].toObject()); });
        deletion_->addAction(text, this, [this, name] { drop(name); });
    }
    addSeparator();
    addAction(tr("Save as..."), this, &PlotSets::askName)->setObjectName("saveSet");
    addMenu(deletion_);
    deletion_->setEnabled(!names.isEmpty());
}

void PlotSets::askName() {
    auto *const dialog = new QInputDialog(parentWidget());
    dialog->setObjectName("setName");
    dialog->setWindowTitle(tr("Save the plots"));
    dialog->setLabelText(tr("Name of the set (one that is there is replaced)"));
    connect(dialog, &QInputDialog::textValueSelected, this, &PlotSets::saveWanted);
    question_.show(dialog);
}

} // namespace hermes::desktop
