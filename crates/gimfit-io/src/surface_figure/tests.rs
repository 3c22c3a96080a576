//! Tests of whole figures.

use super::*;
use crate::figure::svg_to_png;
use resvg::tiny_skia::Pixmap;

/// A fit of any kind, made up: a net off the data, errors that grow.
pub(super) struct Sample {
    dimension: usize,
    shape: [usize; 2],
    data: Vec<f64>,
    net: Vec<f64>,
    parameters: [Vec<f64>; 2],
    residuals: Vec<f64>,
    history: Vec<(usize, f64, f64)>,
    names: Vec<String>,
}

impl Sample {
    /// The points `at` of parameters between 0 and 1.
    pub(super) fn of(
        dimension: usize,
        shape: [usize; 2],
        at: impl Fn(f64, f64) -> Vec<f64>,
    ) -> Self {
        let parameters = shape.map(|count| {
            let last = count.saturating_sub(1).max(1) as f64;
            (0..count).map(|i| i as f64 / last).collect::<Vec<f64>>()
        });
        let mut data = Vec::new();
        for &u in &parameters[0] {
            for &v in &parameters[1] {
                data.extend(at(u, v));
            }
        }
        let count = shape[0] * shape[1];
        Self {
            dimension,
            shape,
            net: data.iter().enumerate().map(|(i, v)| v * (1.0 + 0.02 * (i % 3) as f64)).collect(),
            data,
            parameters,
            residuals: (0..count).map(|i| 1.0e-9 * (1 + i % 1000) as f64).collect(),
            history: (0..20)
                .map(|i| (i, 0.5_f64.powi(i as i32), 0.3 * 0.5_f64.powi(i as i32)))
                .collect(),
            names: Vec::new(),
        }
    }

    fn waves(dimension: usize, shape: [usize; 2]) -> Self {
        Self::of(dimension, shape, |u, v| {
            let wave = (6.0 * u).sin() * (5.0 * v).cos();
            match dimension {
                1 => vec![wave],
                _ => [u, v, 0.3 * wave, u * v].into_iter().cycle().take(dimension).collect(),
            }
        })
    }

    pub(super) fn figure(&self) -> SurfaceFigure<'_> {
        let parameters = [self.parameters[0].as_slice(), self.parameters[1].as_slice()];
        SurfaceFigure {
            title: "<waves> & \"co\" \u{7}",
            caption: "made up, 10⁻³",
            dimension: self.dimension,
            coordinate_names: &self.names,
            closed: [false, false],
            data_shape: self.shape,
            data_points: &self.data,
            parameters,
            net_shape: self.shape,
            control_net: &self.net,
            net_abscissae: parameters,
            mesh_shape: self.shape,
            mesh_parameters: parameters,
            mesh_points: &self.data,
            residuals: &self.residuals,
            extent: 2.0,
            history: &self.history,
            stages: None,
            sequence: &[],
            triangle: false,
        }
    }

    fn svg(&self) -> String {
        checked(&self.figure())
    }
}

/// The figure, once it is seen to be well-formed and not too large.
fn checked(figure: &SurfaceFigure<'_>) -> String {
    let svg = surface_figure_svg(figure);
    let parsed = roxmltree::Document::parse(&svg).unwrap();
    assert_eq!(parsed.root_element().tag_name().name(), "svg");
    assert!(svg.len() < 1_000_000, "{} bytes", svg.len());
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    svg
}

/// Number of closed outlines.
fn facets(svg: &str) -> usize {
    svg.matches("z\"").count() + svg.matches("zM").count() + svg.matches("zm").count()
}

#[test]
fn each_dimension_has_a_figure() {
    for dimension in [0, 1, 2, 3, 4, 6, 100] {
        let svg = Sample::waves(dimension, [9, 7]).svg();
        assert!(svg.contains("Error at each point") && svg.contains("Convergence"));
        assert_eq!(svg.contains("irst 3 of "), dimension > 3);
        assert_eq!(svg.contains("no points to draw"), dimension == 0);
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    for dimension in 1..5 {
        let sample = Sample::waves(dimension, [30, 20]);
        assert_eq!(sample.svg(), sample.svg());
    }
}

#[test]
fn names_and_title_are_shown_escaped() {
    for dimension in [1, 3] {
        let mut sample = Sample::waves(dimension, [5, 5]);
        sample.names = vec!["<a>".to_owned(), "b&b".to_owned()];
        let svg = sample.svg();
        assert!(svg.contains("&lt;a&gt;") && svg.contains("&lt;waves&gt; &amp; &quot;co&quot;"));
        assert_eq!(svg.contains("b&amp;b"), dimension == 3);
    }
}

#[test]
fn the_picture_holds_a_surface_a_net_and_a_map() {
    let svg = Sample::waves(3, [25, 20]).svg();
    let picture = Pixmap::decode_png(&svg_to_png(&svg, 1.0).unwrap()).unwrap();
    let count = |test: &dyn Fn(u8, u8, u8) -> bool| {
        picture.pixels().iter().filter(|p| test(p.red(), p.green(), p.blue())).count()
    };
    let surface = count(&|r, g, b| b > g && g > r && b > 100 && b - r > 20);
    let map = count(&|r, g, b| g > 150 && g > r.saturating_add(60) && b > r);
    let net = count(&|r, _, b| r > 180 && b < 90);
    assert!(surface > 20_000 && map > 5_000 && net > 500, "{surface} {map} {net}");
    assert!(picture.pixels().iter().all(|p| p.alpha() == 255));
}

#[test]
fn a_closed_surface_has_no_seam() {
    let ring = Sample::of(2, [24, 6], |u, v| {
        // The last row lies one step before the first.
        let (sin, cos) = (std::f64::consts::TAU * u * 23.0 / 24.0).sin_cos();
        vec![(1.0 + v) * cos, (1.0 + v) * sin]
    });
    let open = SurfaceFigure { control_net: &[], ..ring.figure() };
    let closed = checked(&SurfaceFigure { closed: [true, false], ..open });
    let open = checked(&open);
    assert_eq!(facets(&closed), facets(&open) + 5);
}

#[test]
fn many_points_stay_small_and_are_accounted_for() {
    for dimension in [1, 2, 3, 6] {
        let svg = Sample::waves(dimension, [400, 300]).svg();
        assert!(svg.contains(" column of samples of the surface drawn"), "{dimension}");
        let (data, net) = ("× 300 data points too close", "× 300 control points too close");
        assert!(svg.contains(data) && svg.contains(net), "{dimension}");
        assert!(svg.contains("shows the largest of 4 × 3 errors"), "{dimension}");
    }
}

#[test]
fn noise_of_a_million_points_stays_small() {
    let noise = |u: f64, v: f64| ((7919.0 * u + 104_729.0 * v).sin() * 43_758.5).fract();
    for (dimension, size) in [(1, 300), (3, 1000)] {
        let mut sample = Sample::of(dimension, [size, size], |u, v| match dimension {
            1 => vec![noise(u, v)],
            _ => vec![noise(u, v), noise(v, u), noise(u + 1.0, v)],
        });
        sample.residuals = sample.data.iter().step_by(dimension).map(|v| v.abs()).collect();
        sample.svg();
    }
}

#[test]
fn the_largest_grids_drawn_in_full_stay_small() {
    let noise = |u: f64, v: f64| ((7919.0 * u + 104_729.0 * v).sin() * 43_758.5).fract();
    for dimension in [1, 2, 3] {
        let at = |u: f64, v: f64| match dimension {
            1 => vec![noise(u, v)],
            _ => vec![u + 0.02 * noise(u, v), v + 0.02 * noise(v, u), 0.3 * noise(u + v, v)],
        };
        let cut = |u: f64, v: f64| at(u, v).into_iter().take(dimension).collect();
        let mesh = Sample::of(dimension, [94, 94], cut);
        let net = Sample::of(dimension, [40, 40], cut);
        let mut data = Sample::of(dimension, [130, 130], cut);
        data.residuals = Sample::of(1, [130, 130], |u, v| vec![noise(u, v).abs()]).data;
        checked(&SurfaceFigure {
            mesh_shape: mesh.shape,
            mesh_points: &mesh.data,
            mesh_parameters: mesh.figure().parameters,
            net_shape: net.shape,
            control_net: &net.data,
            net_abscissae: net.figure().parameters,
            ..data.figure()
        });
    }
}

#[test]
fn long_and_thin_grids_are_drawn() {
    for shape in [[2, 2], [2, 100_000], [100_000, 2], [1, 50], [50, 1], [1, 1], [0, 5], [3, 0]] {
        for dimension in [1, 2, 3] {
            Sample::waves(dimension, shape).svg();
        }
    }
}

#[test]
fn extreme_coordinates_are_drawn() {
    for dimension in [1, 2, 3, 6] {
        for (centre, size) in [
            (0.0, 1.0e300),
            (0.0, f64::MAX),
            (0.0, 1.0e-300),
            (0.0, 5.0e-324),
            (1.0e9, 1.0e-3),
            (1.0e9, 1.0e-8),
            (-1.0e300, 0.0),
            (1.0e-300, 0.0),
            (0.0, 0.0),
            (7.0, 0.0),
            (f64::INFINITY, 1.0),
            (f64::NAN, 1.0),
        ] {
            let mut sample = Sample::waves(dimension, [7, 6]);
            sample.data.iter_mut().for_each(|v| *v = centre + size * *v);
            sample.net = sample.data.clone();
            let svg = sample.svg();
            // Drawing takes long, and places differ little between dimensions.
            let drawn = dimension != 3 || svg_to_png(&svg, 0.2).is_ok();
            assert!(drawn, "{centre} {size}");
            sample.parameters = sample.parameters.map(|p| p.iter().map(|v| v * size).collect());
            sample.svg();
        }
    }
    let mut far = Sample::waves(3, [7, 6]);
    far.data.iter_mut().for_each(|v| *v = 1.0e9 + 1.0e-3 * *v);
    far.net = far.data.clone();
    assert!(far.svg().contains("+ 1 000 000 000"));
}

#[test]
fn flat_surfaces_are_drawn() {
    for k in 0..3 {
        let mut sample = Sample::of(3, [8, 8], |u, v| vec![u, v, 0.0]);
        sample.data.chunks_exact_mut(3).for_each(|p| p.rotate_right(k));
        sample.net = sample.data.clone();
        assert!(!sample.svg().contains("unequal scales"));
    }
    let mut line = Sample::of(3, [8, 8], |u, _| vec![u, u, u]);
    line.net = line.data.clone();
    line.svg();
    let low = Sample::of(3, [8, 8], |u, v| vec![1000.0 * u, 900.0 * v, (9.0 * u * v).sin()]);
    assert!(low.svg().contains("unequal scales"));
}

#[test]
fn mismatched_inputs_are_drawn() {
    for dimension in [1, 2, 3, 7] {
        let sample = Sample::waves(dimension, [6, 5]);
        let mut figure = sample.figure();
        figure.data_points = &sample.data[1..];
        figure.control_net = &sample.data[..1];
        figure.parameters = [&[1.0], &[]];
        figure.net_abscissae = [&[], &[]];
        figure.net_shape = [usize::MAX, 1];
        figure.residuals = &sample.residuals[..7];
        figure.extent = f64::NAN;
        figure.closed = [true, true];
        checked(&figure);
        figure.mesh_points = &[];
        figure.history = &[];
        figure.data_shape = [usize::MAX, usize::MAX];
        checked(&figure);
        figure.data_points = &[];
        checked(&figure);
    }
}

#[test]
fn holes_are_left_out() {
    for dimension in [1, 2, 3] {
        let mut sample = Sample::waves(dimension, [9, 9]);
        let whole = facets(&sample.svg());
        sample.data[40 * dimension] = f64::NAN;
        sample.residuals[40] = f64::NAN;
        assert!(facets(&sample.svg()) < whole);
    }
}

#[test]
fn zero_and_odd_residuals_look_sane() {
    let mut sample = Sample::waves(3, [5, 4]);
    sample.residuals.fill(0.0);
    sample.history = vec![(0, 0.0, 0.0)];
    let svg = sample.svg();
    assert!(svg.contains("all errors are 0") && svg.contains("all residuals are 0"));
    sample.residuals[3] = 1.0e-4;
    assert!(sample.svg().contains("19 of 20 errors are 0 (pale grey)"));
    sample.residuals.fill(f64::NAN);
    assert!(sample.svg().contains("no residuals"));
    for (k, odd) in [f64::INFINITY, -1.0, 5.0e-324, 1.0e308, f64::NAN].into_iter().enumerate() {
        sample.residuals[k] = odd;
        sample.history.push((usize::MAX - k, odd, -odd));
        sample.svg();
    }
}

#[test]
fn a_wild_net_does_not_shrink_the_surface() {
    for dimension in [1, 2, 3] {
        let mut sample = Sample::waves(dimension, [9, 9]);
        sample.net[10] = 1.0e12;
        assert!(sample.svg().contains("reach beyond the picture"));
    }
}

#[test]
fn endless_text_is_cut() {
    let long = "word ".repeat(200_000);
    let sample = Sample::waves(3, [5, 5]);
    let mut figure = sample.figure();
    let names = [long.clone(), "x".repeat(100_000)];
    figure.title = &long;
    figure.caption = &long;
    figure.coordinate_names = &names;
    assert!(checked(&figure).len() < 500_000);
}

#[test]
fn kept_fits_are_drawn_side_by_side_with_their_errors() {
    for dimension in 1..4 {
        let sample = Sample::waves(dimension, [12, 10]);
        let alone = sample.svg();
        let figure = sample.figure();
        let member = |iteration| Member {
            iteration,
            mesh_points: figure.mesh_points,
            residuals: figure.residuals,
        };
        let family: Vec<Member<'_>> = (0..9).map(member).collect();
        for count in [1, 4, 9] {
            let svg = checked(&SurfaceFigure { sequence: &family[..count], ..figure });
            assert_eq!(svg.matches("id=\"kept-").count(), count.min(6));
            assert_eq!(svg.contains("6 of 9 kept fits drawn"), count == 9);
            assert!(facets(&svg) > facets(&alone));
            // The first and the last are always among them.
            assert!(
                svg.contains("iteration 0:") && svg.contains(&format!("iteration {}:", count - 1))
            );
        }
        let empty = Member { iteration: 3, mesh_points: &[], residuals: &[] };
        assert!(checked(&SurfaceFigure { sequence: &[empty], ..figure }).contains("iteration 3:"));
    }
}
