<story>
<p><emotion name="joy" weight="0.35"/><show piece="falcon" layer="outside" turn="0" cut="0"/>Come <gesture name="beckon"/>here, and greet the quietest guest of this house.
A pilgrim carried it home from Alexandria, <gesture name="small" weight="0.8"/>sewn into his cloak, and he swore that it was the falcon of our well.
<gesture name="shrug" weight="0.6"/><show piece="falcon" turn="30"/>For five hundred years nobody knew what was in it, <break time="250ms"/>because nobody dared to cut the linen.</p>

<p><emotion name="joy" weight="0.3"/>You need no knife: <gesture name="explain" weight="0.7"/>hold the glass before it, and look.
First the linen goes, <show piece="falcon" layer="outside" over="inside" share="0.7" turn="0"/><prosody rate="90%">layer after layer after layer.</prosody>
<emotion name="surprise" weight="0.5"/>And then, <break time="400ms"/><show piece="falcon" layer="inside"/>there is a <gesture name="wonder"/><emphasis>bird</emphasis>!
<show piece="falcon" layer="bone" turn="25"/>Its wings are folded and its claws are closed, <prosody volume="soft" rate="88%">as if it had only <gesture name="hush" weight="0.6"/>gone to sleep.</prosody>
<emotion name="joy" weight="0.4"/>Even its last meal is still there, <show piece="falcon" layer="bone" turn="-20"/>a <gesture name="small"/>mouse.</p>

<p><emotion name="surprise" weight="0.4"/>Now look at its <gesture name="point_near"/>left leg.
That is <show piece="falcon" layer="xray" turn="20"/>a ring of <emphasis>gold</emphasis>, and it is much too wide for a falcon.
<emotion name="sadness" weight="0.4"/>Somebody drew it from their own <gesture name="heart"/>finger, <break time="250ms"/><prosody rate="86%">before the last bandage was wound.</prosody></p>

<p><emotion name="fear" weight="0.35"/>And <show piece="falcon" layer="outside" turn="-35"/>the crack in the painted head, <gesture name="sigh"/>well, that was me.
On the very day it came, I <emphasis>dropped</emphasis> it.
I closed the crack <show piece="falcon" layer="metal"/>with resin and with a <gesture name="small" weight="0.8"/>pin of bell metal, painted over it, and told <gesture name="shake_head" weight="0.5"/>nobody.
<break time="300ms"/><emotion name="joy" weight="0.6"/>It would have stayed my secret for ever, <break time="200ms"/>if they had not given you <show piece="falcon" layer="outside" turn="0"/>that <gesture name="laugh" weight="0.7"/>glass.</p>
</story>
