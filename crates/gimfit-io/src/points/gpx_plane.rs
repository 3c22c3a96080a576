//! Longitude and latitude as metres on a plane.
//!
//! The plane touches the WGS84 ellipsoid at the first point, at latitude f0 and
//! longitude l0. With a = 6378137 m, e² = f (2 - f), f = 1 / 298.257223563:
//!
//! ```text
//! n     = a / sqrt(1 - e² sin² f0)            radius across the meridian
//! m     = a (1 - e²) / (1 - e² sin² f0)^(3/2) radius along the meridian
//! east  = n cos(f0) (l - l0)                  differences in radians
//! north = m (f - f0)
//! up    = elevation - elevation of the first point
//! ```
//!
//! This is the first-order approximation. At a distance d north of the first
//! point, eastward lengths are wrong by about d tan(f0) / 6378 km of themselves
//! (0.2 % for d = 10 km at 50 degrees), and lengths measured at a height h
//! appear short by h / 6378 km. Near the poles it does not hold.

const SEMI_MAJOR: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// The plane that touches the ellipsoid at one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    longitude: f64,
    latitude: f64,
    metres_per_degree_east: f64,
    metres_per_degree_north: f64,
}

impl Plane {
    /// The plane at a point in degrees.
    pub(super) fn at(longitude: f64, latitude: f64) -> Self {
        let (sin, cos) = latitude.to_radians().sin_cos();
        let e2 = FLATTENING * (2.0 - FLATTENING);
        let root = (1.0 - e2 * sin * sin).sqrt();
        let across = SEMI_MAJOR / root;
        let along = SEMI_MAJOR * (1.0 - e2) / (root * root * root);
        Plane {
            longitude,
            latitude,
            metres_per_degree_east: (across * cos).to_radians(),
            metres_per_degree_north: along.to_radians(),
        }
    }

    /// Metres east of the point, the short way round.
    pub(super) fn east(&self, longitude: f64) -> f64 {
        let mut difference = longitude - self.longitude;
        if difference > 180.0 {
            difference -= 360.0;
        } else if difference < -180.0 {
            difference += 360.0;
        }
        difference * self.metres_per_degree_east
    }

    /// Metres north of the point.
    pub(super) fn north(&self, latitude: f64) -> f64 {
        (latitude - self.latitude) * self.metres_per_degree_north
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_have_the_lengths_of_the_tables() {
        // Lengths of one degree on WGS84, to the metre.
        for (latitude, north, east) in
            [(0.0, 110_574.3, 111_319.5), (45.0, 111_131.8, 78_846.8), (60.0, 111_412.3, 55_800.0)]
        {
            let plane = Plane::at(10.0, latitude);
            assert!((plane.north(latitude + 1.0) - north).abs() < 1.0, "{latitude}");
            assert!((plane.east(11.0) - east).abs() < 1.0, "{latitude}");
        }
    }

    #[test]
    fn east_goes_the_short_way_over_the_date_line() {
        let plane = Plane::at(179.9, 0.0);
        assert!((plane.east(-179.9) - 0.2 * 111_319.5).abs() < 1.0);
    }
}
