//! Pressure of detonation products by Jones, Wilkins and Lee.
//! [E. L. Lee, H. C. Hornig, J. W. Kury, UCRL-50422, 1968; B. M. Dobratz, P. C. Crawford, UCRL-52997, 1985]

/// Coefficients of p = A (1 - w / (R1 V)) exp(-R1 V) + B (1 - w / (R2 V)) exp(-R2 V) + w E / V. V is the volume over that of the solid
/// explosive, E the internal energy per volume of the solid explosive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jwl {
    /// A \[Pa\].
    pub a: f64,
    /// B \[Pa\].
    pub b: f64,
    /// R1 \[1\].
    pub r1: f64,
    /// R2 \[1\].
    pub r2: f64,
    /// w \[1\].
    pub omega: f64,
    /// E of the detonation \[J m^-3\].
    pub energy: f64,
}

/// Where a plane detonation leaves its products.
#[derive(Clone, Copy, Debug)]
pub struct ChapmanJouguet {
    /// Speed of the detonation \[m s^-1\].
    pub speed: f64,
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Volume over that of the solid explosive.
    pub volume: f64,
}

impl Jwl {
    /// The part of the pressure that does not depend on E \[Pa\].
    pub fn cold(&self, volume: f64) -> f64 {
        let term = |factor: f64, rate: f64| factor * (1.0 - self.omega / (rate * volume)) * (-rate * volume).exp();
        term(self.a, self.r1) + term(self.b, self.r2)
    }

    /// A, B \[Pa\], R1 and R2 times the density of the explosive \[kg m^-3\]: as shaders have them.
    pub fn rates(&self, density: f64) -> [f64; 4] {
        [self.a, self.b, self.r1 * density, self.r2 * density]
    }

    /// Pressure at no temperature \[Pa\].
    pub fn at_rest(&self, volume: f64) -> f64 {
        self.a * (-self.r1 * volume).exp() + self.b * (-self.r2 * volume).exp()
    }

    /// Density times speed of sound squared, beyond that of an ideal gas of gamma = 1 + w at the same pressure \[Pa\].
    pub fn cold_stiffness(&self, volume: f64) -> f64 {
        let term = |factor: f64, x: f64| factor * (x - self.omega - 1.0) * (-x).exp();
        term(self.a, self.r1 * volume) + term(self.b, self.r2 * volume)
    }

    /// Pressure \[Pa\] at a volume and an energy \[J m^-3\].
    pub fn pressure(&self, volume: f64, energy: f64) -> f64 {
        self.cold(volume) + self.omega * energy / volume
    }

    /// Speed of sound squared times the density of the solid explosive \[Pa\]: -V^2 dp/dV at constant entropy.
    pub fn stiffness(&self, volume: f64, energy: f64) -> f64 {
        let term = |factor: f64, rate: f64| {
            let x = rate * volume;
            factor * (x * x - self.omega * x - self.omega) * (-x).exp() / rate
        };
        let falls = term(self.a, self.r1) + term(self.b, self.r2) + self.omega * energy;
        falls + self.omega * volume * self.pressure(volume, energy)
    }

    /// The Chapman-Jouguet state: of all ends of Rayleigh lines on the Hugoniot curve E = E0 + p (1 - V) / 2 the one of the slowest
    /// detonation.
    pub fn chapman_jouguet(&self, density: f64) -> ChapmanJouguet {
        let pressure = |volume: f64| {
            (self.cold(volume) + self.omega * self.energy / volume)
                / (1.0 - self.omega * (1.0 - volume) / (2.0 * volume))
        };
        let square = |volume: f64| pressure(volume) / (density * (1.0 - volume));
        let (mut low, mut high) = (0.5, 0.95);
        for _ in 0..200 {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if square(a) < square(b) { high = b } else { low = a }
        }
        let volume = 0.5 * (low + high);
        ChapmanJouguet { speed: square(volume).sqrt(), pressure: pressure(volume), volume }
    }
}
