//! Undoing and redoing changes of the scene.

use splashdown::scene::Scene;

/// Number of changes that can be undone.
const LIMIT: usize = 100;

/// Earlier and later states of a scene.
#[derive(Clone, Debug, Default)]
pub struct History {
    past: Vec<Scene>,
    future: Vec<Scene>,
}

impl History {
    /// Records the scene before a change.
    pub fn record(&mut self, before: Scene) {
        self.future.clear();
        self.past.push(before);
        if self.past.len() > LIMIT {
            self.past.remove(0);
        }
    }

    /// Forgets changes that were refused: the scene before them is the scene again.
    pub fn forget_repeated(&mut self, now: &Scene) {
        while self.past.pop_if(|before| before == now).is_some() {}
    }

    /// The scene before the last change; `now` is restored by [`redo`](Self::redo).
    pub fn undo(&mut self, now: &Scene) -> Option<Scene> {
        let before = self.past.pop()?;
        self.future.push(now.clone());
        Some(before)
    }

    /// The scene before the last [`undo`](Self::undo).
    pub fn redo(&mut self, now: &Scene) -> Option<Scene> {
        let after = self.future.pop()?;
        self.past.push(now.clone());
        Some(after)
    }

    /// Whether there is something to undo and to redo.
    pub fn can_undo_and_redo(&self) -> (bool, bool) {
        (!self.past.is_empty(), !self.future.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::scene::presets;

    #[test]
    fn changes_are_undone_in_reverse_order() {
        let (name, text) = presets()[0];
        let mut scene = Scene::parse(text, name).unwrap();
        let mut history = History::default();
        assert_eq!(history.undo(&scene), None);
        let original = scene.clone();
        for duration in [2.0, 3.0] {
            history.record(scene.clone());
            scene.duration = duration;
        }
        scene = history.undo(&scene).unwrap();
        assert_eq!(scene.duration, 2.0);
        scene = history.undo(&scene).unwrap();
        assert_eq!(scene, original);
        assert_eq!(history.can_undo_and_redo(), (false, true));
        scene = history.redo(&scene).unwrap();
        assert_eq!(scene.duration, 2.0);
        // A change after undoing forgets what was undone.
        history.record(scene.clone());
        scene.duration = 9.0;
        assert_eq!(history.redo(&scene), None);
        assert_eq!(history.undo(&scene).unwrap().duration, 2.0);
    }

    #[test]
    fn a_refused_change_is_forgotten() {
        let (name, text) = presets()[0];
        let first = Scene::parse(text, name).unwrap();
        let mut second = first.clone();
        second.duration = 2.0;
        let mut history = History::default();
        history.record(first.clone());
        history.record(second.clone());
        history.forget_repeated(&second);
        // Control: the change before remains.
        assert_eq!(history.undo(&second), Some(first));
    }
}
