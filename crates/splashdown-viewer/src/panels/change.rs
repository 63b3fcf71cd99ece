//! Changes of the things of a scene: blocks, meshes, bodies and emitters. Each of them can be undone.

use splashdown::scene::Scene;

use crate::state::{Action, State, Tool};
use crate::{edit, save};

/// Changes the things of the scene: with the tool Edit at time 0, else in the running simulation. `now` is the time of the
/// window's clock in s.
pub fn apply(state: &mut State, actions: &mut Vec<Action>, now: f64, change: impl FnOnce(&mut Scene)) {
    if state.tool == Tool::Edit && state.timeline.is_none() {
        at_start(state, actions, now, change);
        return;
    }
    let before = state.scene.clone();
    change(&mut state.scene);
    if state.scene != before {
        state.history.record(before);
        actions.push(Action::Change);
    }
}

/// Changes the things of the scene at time 0.
pub fn at_start(state: &mut State, actions: &mut Vec<Action>, now: f64, change: impl FnOnce(&mut Scene)) {
    let before = state.scene.clone();
    change(&mut state.scene);
    finish(state, before, actions, now);
}

/// Ends a change at time 0. One that a scene file could not contain, such as a block outside the domain, is taken back
/// with the reason.
pub(super) fn finish(state: &mut State, before: Scene, actions: &mut Vec<Action>, now: f64) {
    if state.scene == before {
        return;
    }
    let checked = match edit::has_fluid(&state.scene) {
        true => save::scene(&state.scene, &state.orbit).map(drop),
        false => Err("a scene needs fluid. Add another block, emitter or filled mesh first".to_owned()),
    };
    match checked {
        Ok(()) => {
            state.history.record(before);
            start_again(state, actions);
        }
        Err(reason) => {
            state.scene = before;
            state.notify(format!("The change was undone: {reason}"), true, now);
        }
    }
}

/// Shows the scene at time 0.
pub(super) fn start_again(state: &mut State, actions: &mut Vec<Action>) {
    state.playing = false;
    state.count();
    actions.push(Action::Restart);
}

pub(super) fn undo(state: &mut State, actions: &mut Vec<Action>) {
    if let Some(scene) = state.history.undo(&state.scene) {
        restore(state, scene);
        start_again(state, actions);
    }
}

pub(super) fn redo(state: &mut State, actions: &mut Vec<Action>) {
    if let Some(scene) = state.history.redo(&state.scene) {
        restore(state, scene);
        start_again(state, actions);
    }
}

/// Takes back what these changes concern, and nothing else: the settings remain.
fn restore(state: &mut State, scene: Scene) {
    state.scene.fluid.blocks = scene.fluid.blocks;
    state.scene.fluid.meshes = scene.fluid.meshes;
    state.scene.bodies = scene.bodies;
    state.scene.emitters = scene.emitters;
    state.scene.duration = scene.duration;
}
