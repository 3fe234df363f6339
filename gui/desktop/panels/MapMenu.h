#pragma once

#include "gui/desktop/model/DaemonLink.h"
#include "gui/desktop/widgets/OneDialog.h"

#include <QMenu>
#include <QPointer>
#include <functional>

namespace hermes::desktop {

/// The map of the chosen robot's matcher: begun anew, opened, saved, exported, brought back; mapping or
/// localization. What replaces the map asks first, in a window that keeps nothing from its place, and can be
/// undone.
class MapMenu : public QMenu {
    Q_OBJECT
public:
    explicit MapMenu(QWidget *parent = nullptr);

    /// Whose map it is; null: nobody's.
    void setMatcher(DaemonLink *matcher);
    /// What is asked is of a map, mode or robot that is no more.
    void endQuestion() { question_.close(); }

Q_SIGNALS:
    /// How a command ended, or that it goes on.
    void told(const QString &text, bool isError);
    /// The robot is sought in a map that was told of; what holds of it once the robot was found.
    void sought(const QString &text);
    /// A person has looked: the robot is where it is shown.
    void confirmed();

private:
    using Then = std::function<void(const QJsonValue &)>;

    QAction *add(const QString &text, const char *name, const char *method,
                 const std::function<void()> &work);
    void call(const QString &method, const QJsonObject &params, const Then &then);
    void startNew();
    void open();
    void load(const QString &path);
    void save();
    void saveAs();
    void exportAs();
    void confirm();
    void undo(bool again);
    void setMode(const QString &mode);
    /// Asks for the name of a file on the robot.
    void askName(const QString &title, const QString &name, const std::function<void(const QString &)> &use);
    void ask(const QString &question, const QString &yes, const std::function<void()> &work);
    void write(const QString &method, QJsonObject params);
    void readMode();
    void update();

    QPointer<DaemonLink> matcher_;
    OneDialog question_;                                 ///< two would mean different maps
    std::vector<std::pair<QAction *, QString>> actions_; ///< with the method that each needs
    QAction *save_ = nullptr, *undo_ = nullptr, *redo_ = nullptr, *confirm_ = nullptr, *mapping_ = nullptr,
            *localization_ = nullptr;
    QString path_; ///< of the map, as it was opened or saved last
};

} // namespace hermes::desktop
