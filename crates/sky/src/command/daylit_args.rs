//! Arguments of `gendaylit`.

use super::args::{Args, When, when};
use crate::perez::DEFAULT_DEW_POINT_C;
use crate::{Clock, RadianceSite};
use sunpeak_core::Result;

/// What the weather is known by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Input {
    /// `-P`: ε and Δ.
    Perez { clearness: f64, brightness: f64 },
    /// `-W`: irradiances [W/m²].
    Normal { direct_normal: f64, diffuse_horizontal: f64 },
    /// `-L`: illuminances [lx].
    NormalLux { direct_normal: f64, diffuse_horizontal: f64 },
    /// `-G`: irradiances [W/m²].
    Horizontal { direct_horizontal: f64, diffuse_horizontal: f64 },
    /// `-E`: irradiance [W/m²].
    Global { horizontal: f64 },
}

/// `-O`: what the brightness is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Output {
    /// 0: luminance / 179 [W sr⁻¹ m⁻²].
    Visible,
    /// 1: radiance of the whole solar spectrum [W sr⁻¹ m⁻²].
    Solar,
    /// 2: luminance [cd/m²].
    Lumen,
}

/// Daylight locus: eight terms of x over colour temperature (two ranges), three of y over x (perezlum_c.cal, A12 to A22).
pub(super) type Locus = [f64; 11];

/// Skies measured in Berlin: `gendaylit`'s default.
const BERLIN_LOCUS: Locus = [
    -4.843e9, 2.5568e6, 0.24282e3, 0.23258, -4.843e9, 2.5568e6, 0.24282e3, 0.23258, -1.2848, 1.7519,
    -0.093786,
];

/// CIE 15, with the first term of the first range as `gendaylit` has it (-4.607e9).
const CIE_LOCUS: Locus =
    [-4.607e9, 2.9678e6, 0.09911e3, 0.244063, -2.0064e9, 1.9018e6, 0.24748e3, 0.23704, -3.0, 2.87, -0.275];

#[derive(Debug)]
pub(super) struct Request {
    pub when: When,
    pub site: RadianceSite,
    pub input: Input,
    pub output: Output,
    /// `-c`: no limit to the sun's altitude.
    pub cloudy: bool,
    pub with_sun: bool,
    pub ground_reflectance: f64,
    pub dew_point_c: f64,
    /// `-i` [min]; 0 is none.
    pub interval_min: f64,
    /// `-C`: the locus of a coloured sky.
    pub color: Option<Locus>,
}

impl Request {
    pub fn parse(args: &[String]) -> Result<Self> {
        let mut args = Args::new("gendaylit", args);
        let when = when(&mut args, read_hour)?;
        let mut request = Self {
            when,
            site: RadianceSite::default(),
            input: Input::Perez { clearness: 0.0, brightness: 0.0 },
            output: Output::Visible,
            cloudy: false,
            with_sun: true,
            ground_reflectance: 0.2,
            dew_point_c: DEFAULT_DEW_POINT_C,
            interval_min: 0.0,
            color: None,
        };
        let (mut colored, mut locus) = (false, BERLIN_LOCUS);
        while let Some(option) = args.next() {
            match option {
                "-C" => colored = true,
                "-CIE" => locus = CIE_LOCUS,
                "-l" => locus = read_locus(option, &mut args)?,
                _ if request.weather_option(option, &mut args)? => {}
                _ => request.option(option, &mut args)?,
            }
        }
        request.color = colored.then_some(locus);
        Ok(request)
    }

    /// `-P -W -L -G -E`; the last one counts. `false` if it is another option.
    fn weather_option(&mut self, option: &str, args: &mut Args) -> Result<bool> {
        const DIFFUSE: &str = "diffuse horizontal irradiance [W/m²]";
        self.input = match option {
            "-P" => Input::Perez {
                clearness: args.number(option, "epsilon")?,
                brightness: args.number(option, "delta")?,
            },
            "-W" => Input::Normal {
                direct_normal: args.number(option, "direct normal irradiance [W/m²]")?,
                diffuse_horizontal: args.number(option, DIFFUSE)?,
            },
            "-L" => Input::NormalLux {
                direct_normal: args.number(option, "direct normal illuminance [lx]")?,
                diffuse_horizontal: args.number(option, "diffuse horizontal illuminance [lx]")?,
            },
            "-G" => Input::Horizontal {
                direct_horizontal: args.number(option, "direct horizontal irradiance [W/m²]")?,
                diffuse_horizontal: args.number(option, DIFFUSE)?,
            },
            "-E" => {
                Input::Global { horizontal: args.number(option, "global horizontal irradiance [W/m²]")? }
            }
            _ => return Ok(false),
        };
        Ok(true)
    }

    fn option(&mut self, option: &str, args: &mut Args) -> Result<()> {
        match option {
            "-s" | "+s" => (self.cloudy, self.with_sun) = (false, option == "+s"),
            "-c" | "+c" => (self.cloudy, self.with_sun) = (true, false),
            "-w" => {} // warnings are comments here
            "-y" => {
                let year = args.year(option)?;
                if let When::Time { date, .. } = &mut self.when {
                    date.year = year;
                }
            }
            "-O" => self.output = read_output(option, args)?,
            "-g" => self.ground_reflectance = args.number(option, "the ground's reflectance")?,
            "-a" => self.site.latitude_deg = args.number(option, "the latitude [deg north]")?,
            "-o" => self.site.longitude_west_deg = args.number(option, "the longitude [deg west]")?,
            "-m" => self.site.meridian_west_deg = args.number(option, "the standard meridian [deg west]")?,
            "-i" => self.interval_min = read_interval(option, args)?,
            "-d" => {
                let dew_point_c = args.number(option, "the dew point [°C]")?;
                let is_plausible = (-40.0..=40.0).contains(&dew_point_c);
                self.dew_point_c = if is_plausible { dew_point_c } else { DEFAULT_DEW_POINT_C };
            }
            // Read and without effect in the program.
            "-b" | "-t" | "-R" => drop(args.number(option, "a number")?),
            _ => {
                return Err(args.error(format!(
                    "unknown option \"{option}\"; known are -P -W -L -G -E -O -C -CIE -l -s +s -c +c -w -y -g -a -o -m -i -d"
                )));
            }
        }
        Ok(())
    }
}

fn read_output(option: &str, args: &mut Args) -> Result<Output> {
    match args.text(option, "0, 1 or 2")? {
        "0" => Ok(Output::Visible),
        "1" => Ok(Output::Solar),
        "2" => Ok(Output::Lumen),
        other => Err(args
            .error(format!("{option}: expected 0 (visible), 1 (solar) or 2 (luminance), found \"{other}\""))),
    }
}

fn read_interval(option: &str, args: &mut Args) -> Result<f64> {
    let minutes = args.number(option, "the time interval [min]")?;
    if minutes < 0.0 {
        return Err(
            args.error(format!("{option}: expected a time interval of 0 or more minutes, found {minutes}"))
        );
    }
    Ok(minutes)
}

/// `-l l1 … l7`: l1 to l4 serve both ranges of the colour temperature.
fn read_locus(option: &str, args: &mut Args) -> Result<Locus> {
    let mut l = [0.0; 7];
    for (i, value) in l.iter_mut().enumerate() {
        *value = args.number(option, &format!("number {} of 7 of the daylight locus", i + 1))?;
    }
    Ok([l[0], l[1], l[2], l[3], l[0], l[1], l[2], l[3], l[4], l[5], l[6]])
}

/// Decimal hours only: the program reads 14:30 and 14EST as 14, without a word.
fn read_hour(args: &Args, text: &str) -> Result<Clock> {
    let digits = text.strip_prefix('+').unwrap_or(text);
    match digits.parse::<f64>() {
        Ok(hour) if (0.0..24.0).contains(&hour) && !digits.starts_with('+') => {
            Ok(if digits == text { Clock::Standard(hour) } else { Clock::Solar(hour) })
        }
        _ => Err(args.error(format!(
            "hour: expected decimal hours from 0 to below 24 such as 14.5, or +14.5 (solar time), found \"{text}\""
        ))),
    }
}
