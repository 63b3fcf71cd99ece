//! Runs whose fluid bursts: messages, exit codes, and what is left.

use std::fs;

use crate::place::{Outcome, Place, lines, names, stderr};
use serde_json::Value;

/// Water without stiffness: it collapses under its own weight.
const SOFT: &str = "[scene]\nname = \"soft\"\nduration = 0.6\n[domain]\nmin = [0, 0, 0]\nmax = [0.8, 1.2, 0.4]\n[fluid]\n\
    particle_spacing = 0.05\ninitial_pressure = \"zero\"\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.8, 1.0, 0.4]\n[solver]\nsound_speed = 0.05\n\
    [surface]\nenabled = false\n[[probe]]\nname = \"balance\"\nquantity = \"energy\"\n";

fn report(place: &Place) -> Result<Value, Box<dyn std::error::Error>> {
    Ok(serde_json::from_str(&fs::read_to_string(place.path("out/run.json"))?)?)
}

#[test]
fn a_burst_stops_the_run_and_can_be_resumed() -> Outcome {
    let place = Place::new()?;
    place.write("soft.toml", SOFT)?;
    let options = ["run", "soft.toml", "--device", "cpu", "--no-pictures", "--json", "--out", "out"];
    let output = place.splashdown(&options).output()?;
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let all = lines(&output)?;
    let last = all.last().ok_or("no lines")?;
    let message = last["message"].as_str().ok_or("no message")?;
    assert_eq!((&last["event"], &last["exit_code"]), (&Value::from("error"), &Value::from(1)));
    for word in ["the fluid has burst: at ", "m at the side", "--on-burst warn"] {
        assert!(message.contains(word), "{word} is missing in {message}");
    }
    // The frame in which it was found is complete, and there is a checkpoint before it.
    let stopped = report(&place)?;
    let frames = stopped["complete_frames"].as_u64().ok_or("no frames")?;
    assert_eq!(names(&place.path("out/particles"))?.len() as u64, frames);
    assert!(frames > 1 && frames < 31, "{frames}");
    assert_eq!((&stopped["status"], &stopped["monitor"]["level"]), (&"failed".into(), &"stop".into()));
    let alarms = stopped["monitor"]["alarms"].as_array().ok_or("no alarms")?;
    assert!(alarms.iter().any(|alarm| alarm["level"] == "stop" && alarm["place"].is_array()), "{alarms:?}");
    assert_eq!(names(&place.path("out/checkpoints"))?.len(), 1);

    let output = place.splashdown(&["run", "--resume", "out", "--on-burst", "warn", "--json"]).output()?;
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let finished = report(&place)?;
    assert_eq!((&finished["status"], &finished["complete_frames"]), (&"finished".into(), &31.into()));
    assert!(lines(&output)?.iter().any(|line| line["event"] == "warning"));
    // The probe has one row per frame and a heading.
    let table = fs::read_to_string(place.path("out/probes/balance.csv"))?;
    assert_eq!(table.lines().count(), 32);
    assert!(table.starts_with("time (s),kinetic energy (J)"), "{table}");
    Ok(())
}

#[test]
fn a_step_that_becomes_too_short_is_explained() -> Outcome {
    let place = Place::new()?;
    let fast = "sound_speed = 3\nmethod = \"wcsph\"\ndensity = \"continuity\"\nnegative_pressure = \"keep\"\nmin_dt = 3e-3";
    place.write("fast.toml", SOFT.replace("sound_speed = 0.05", fast))?;
    let output = place
        .splashdown(&["run", "fast.toml", "--device", "cpu", "--no-pictures", "--out", "out"])
        .output()?;
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    let error = message.lines().find(|line| line.starts_with("error: ")).ok_or("no error")?;
    assert!(
        error.contains("below solver.min_dt") && error.contains("the speed of sound, 3 m/s, is too low"),
        "{error}"
    );
    assert!(message.contains("Resume with"), "{message}");
    let stopped = report(&place)?;
    // The water is compressed by two thirds and does not burst.
    assert_eq!((&stopped["status"], &stopped["monitor"]["level"]), (&"failed".into(), &"warning".into()));
    Ok(())
}
