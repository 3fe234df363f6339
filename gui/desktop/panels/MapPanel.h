#pragma once

#include "gui/desktop/view/MapView.h"
#include "gui/desktop/widgets/SaveDialog.h"
#include "gui/desktop/widgets/WrittenFile.h"

class QAction;
class QMenu;
class QToolBar;

namespace hermes::desktop {

class MapMenu;
class MessageLabel;

/// The map view with its tools: menu of the map, follow, fit, measure, place, relocalize, layers, export.
class MapPanel : public QWidget {
    Q_OBJECT
public:
    explicit MapPanel(Fleet &fleet, QWidget *parent = nullptr);

    MapView &view() { return *view_; }
    const MapModel &model() const { return model_; }
    QMenu &mapMenu();
    QMenu &layersMenu() { return *layers_; }
    /// Whether each layer is ticked, by its name, for the next start.
    QVariantMap layers() const;
    void setLayers(const QVariantMap &ticks);
    /// Follow, fit, measure, place, relocalize.
    QList<QAction *> tools() const { return {follow_, fit_, measure_, place_, relocalize_}; }
    /// Writes what the view shows; .svg by its name, else a picture. Error: the file cannot be written.
    Result<void> exportTo(const QString &file) const { return drawn(file)(); }

private:
    Writing drawn(const QString &file) const;
    void addTools(QToolBar &bar);
    void addMap(QToolBar &bar);
    void addLayers(QToolBar &bar);
    void tellFound();
    void askFile();
    /// A command of the matcher; tells how it ended.
    void ask(const QString &method, const QJsonObject &params, const QString &done);
    void updateTools();

    MapModel model_;
    MapView *view_;
    MapMenu *map_;
    QMenu *layers_ = nullptr;
    MessageLabel *message_;
    OneDialog export_;
    std::pair<QString, QString> sought_; // what was told, and is once the robot was found
    QAction *follow_, *fit_, *measure_, *place_, *relocalize_;
};

} // namespace hermes::desktop
