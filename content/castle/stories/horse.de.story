<story>
<p><emotion name="joy" weight="0.35"/><gesture name="count_two"/>Zwei Brüder stritten sich einmal um ein Pferd.
<emotion name="anger" weight="0.4"/>Es war das beste Pferd der Burg, und jeder von ihnen sagte: <gesture name="emphasize"/>Es gehört <emphasis level="strong">mir</emphasis>.
Sie schrien so laut, dass die <gesture name="point_up" weight="0.8"/>Raben den Turm verließen.</p>

<p><emotion name="neutral"/>Schließlich wollten sie um die Wette reiten, und das Pferd sollte frei zwischen ihnen laufen.
<emotion name="surprise" weight="0.4"/>Unten am Fluss ging es los, <prosody rate="105%">schneller,</prosody> <prosody rate="118%">und schneller,</prosody> <prosody rate="130%">und schneller.</prosody>
<break time="300ms"/><emotion name="joy" weight="0.7"/>Und in <gesture name="explain"/>genau derselben Kurve <break time="250ms"/>fielen beide in genau denselben Graben.<gesture name="laugh"/></p>

<p><emotion name="joy" weight="0.3"/><look at="horse"/>Das Pferd kam <emphasis>allein</emphasis> nach Hause.
<look at="visitor"/>Es blieb im Hof stehen, trank aus dem Brunnen und ließ niemanden an sich heran <gesture name="heart" weight="0.7"/>als die Kinder.</p>

<p><emotion name="sadness" weight="0.4"/>Sieben Tage lang sahen ihm die Brüder zu, aus zwei verschiedenen Fenstern.
<break time="300ms"/><prosody rate="88%">Am achten Tag <gesture name="sigh"/>schämten sie sich.</prosody></p>

<p><emotion name="joy" weight="0.5"/>Von da an herrschten sie gemeinsam, mit einem Tisch, einem Schlüssel <point at="sword"/>und einem Schwert.
<look at="horse"/>Und das Pferd ließen sie in Bronze gießen, <gesture name="large"/>steigend, ohne Sattel und ohne Zaum, damit es nie jemandem gehören kann.</p>

<p><look at="visitor"/>Gehen Sie hinüber und sehen Sie genau hin: <gesture name="point_near"/>Ein Huf ist ganz blank.
Dort berühren ihn die Kinder noch heute, weil es Glück bringt.
<break time="400ms"/><emotion name="joy" weight="0.8"/>Sie dürfen das auch; <look at="fireplace"/><prosody rate="92%">ich schaue so lange <gesture name="shrug" weight="0.6"/>weg.</prosody></p>
</story>
