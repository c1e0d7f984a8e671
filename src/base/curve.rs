//! Error against time: how long until an error, and which error by a time?
//!
//! Curves are straight lines between their points on log-log axes. Beyond the last point, and before the first, the
//! error falls as one over the time after set-up: as that of independent passes.

/// Seconds until `error`, from set-up and the seconds and errors after rising numbers of passes. The first time, where
/// the curve comes back up. NaN of an empty curve.
pub fn seconds_to(error: f64, setup_s: f64, seconds: &[f64], errors: &[f64]) -> f64 {
    let Some(last) = seconds.len().min(errors.len()).checked_sub(1) else { return f64::NAN };
    let reached = errors.iter().position(|e| *e <= error);
    match reached {
        Some(i) if i > 0 => between(error, (errors[i - 1], seconds[i - 1]), (errors[i], seconds[i])),
        _ => {
            let i = reached.unwrap_or(last);
            setup_s + (seconds[i] - setup_s) * errors[i] / error
        }
    }
}

/// Error by a time in `seconds`, of the same curve; infinite within its set-up, NaN of an empty one.
pub fn error_at(time_s: f64, setup_s: f64, seconds: &[f64], errors: &[f64]) -> f64 {
    let Some(last) = seconds.len().min(errors.len()).checked_sub(1) else { return f64::NAN };
    if time_s <= setup_s {
        return f64::INFINITY;
    }
    let later = seconds.iter().position(|s| *s >= time_s);
    match later {
        Some(i) if i > 0 => between(time_s, (seconds[i - 1], errors[i - 1]), (seconds[i], errors[i])),
        _ => {
            let i = later.unwrap_or(last);
            errors[i] * (seconds[i] - setup_s) / (time_s - setup_s)
        }
    }
}

/// The ordinate at `x` of the line through two points on log-log axes.
fn between(x: f64, a: (f64, f64), b: (f64, f64)) -> f64 {
    let along = (x / a.0).ln() / (b.0 / a.0).ln();
    a.1 * (along * (b.1 / a.1).ln()).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECONDS: [f64; 3] = [2.0, 5.0, 17.0];
    const ERRORS: [f64; 3] = [0.8, 0.2, 0.05];

    #[test]
    fn points_of_a_curve_are_met_from_both_sides() {
        for (s, e) in SECONDS.into_iter().zip(ERRORS) {
            assert!((seconds_to(e, 1.0, &SECONDS, &ERRORS) - s).abs() < 1e-12);
            assert!((error_at(s, 1.0, &SECONDS, &ERRORS) - e).abs() < 1e-12);
        }
    }

    #[test]
    fn both_readings_are_one_curve() {
        for e in [3.0, 0.5, 0.1, 0.01] {
            let s = seconds_to(e, 1.0, &SECONDS, &ERRORS);
            assert!((error_at(s, 1.0, &SECONDS, &ERRORS) / e - 1.0).abs() < 1e-12, "{e}");
        }
        // 16 seconds after set-up have 0.05: a tenth of that takes ten times as long.
        assert!((seconds_to(0.005, 1.0, &SECONDS, &ERRORS) - 161.0).abs() < 1e-9);
        assert!((seconds_to(1.6, 1.0, &SECONDS, &ERRORS) - 1.5).abs() < 1e-12);
        // Halfway between two points on log-log axes lies their geometric mean.
        assert!((seconds_to(0.1, 1.0, &SECONDS, &ERRORS) - 85.0f64.sqrt()).abs() < 1e-9);
        assert!(error_at(0.5, 1.0, &SECONDS, &ERRORS).is_infinite() && seconds_to(0.1, 1.0, &[], &[]).is_nan());
    }
}
